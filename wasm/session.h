#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "buffer.h"
#include "editor.h"
#include "geometry/mesh.h"
#include "io/scan.h"
#include "measured/export_files.h"
#include "model_shelf.h"
#include "painter.h"
#include "pipeline/pipeline.h"
#include "task.h"
#include "teaching_json.h"

namespace vitruvian::wasm {

/// What the page's worker holds: models, one scan, and what was found in it. Results of a task are described
/// by JSON in which an array is `[address, number of elements]`; it stays valid until the next task starts.
class Session {
 public:
  explicit Session(int threads) : task_(threads) {}
  ~Session();

  Task& task() { return task_; }

  ModelShelf& models() { return models_; }
  /// Starts to put the user's model files to use that were added to models(); asks for networks as begin()
  /// does. All that was found with other models is dropped as soon as these are in use; when that fails, all
  /// stays. @param known_landmarks  see ModelShelf::begin().
  void use_models(const std::string& known_landmarks);

  /// Starts to read a scan; replaces the one before and all that was found in it.
  void open(Buffer file, std::string name);
  /// `{"vertices", "faces", "decimated", "origin", "notes", "positions", "normals", "indices"}` of the scan
  /// that was opened.
  std::string scan_report() const;

  /// Takes settings over. @param settings  JSON as chosen_settings() reads it: any of the `settings` of
  /// registration.json, edits made by hand (`body_from_scan`, `keypoints`, `regions`, `start`) included.
  /// @return how many of the pipeline's stages still hold, 0..4.  @throws Error(usage, not_available).
  int configure(const std::string& settings);
  /// Starts to work the opened scan up to a stage: only what is not there yet, or that stage and all after it
  /// anew. The task ends at the first network request, or when the stage is reached.
  /// @param until  a PipelineStage.  @throws Error(usage).
  void begin(int until, bool again);
  /// `{"network", "inputs": [array...]}`, or null when the stage is reached.
  std::string request_report() const;
  /// Memory for `size` floats that answer output `output` of input `input`; outputs in their order.
  float* reply_buffer(std::size_t input, std::size_t output, std::size_t size);
  /// Hands the reply to the pipeline and goes on until the next request or the stage.
  void resume();

  /// `{"align", "keypoints", "pose", "result"}` of the stages that are reached, null for the others.
  std::string findings_report();
  /// Answers a request of the page's editors (classes Editor, Painter) about the opened scan.
  std::string edit(const std::string& request);
  /// `{"files": [{"name", "data"}]}`: what the command line writes, with the mesh as "ply", "obj" or "glb".
  std::string files_report(const std::string& mesh_format);
  /// measurements.json with where each dimension lies, see describe_measurements(), and the re-posed bodies:
  /// "standing" and "seated" (arrays of vertices, body frame) and "faces".
  std::string measurements_report();
  /// See describe_profile().
  std::string profile_report(const std::string& segment, int count);
  /// As files_report(); see measured_files().
  std::string measured_files_report(const std::string& format);

  /// describe_body() of the model that is loaded.
  std::string body_report() const { return describe_body(models_.models()).dump(); }
  /// Poses the body by hand, with or without a scan. @return describe_posed().
  std::string pose_body(const std::string& parameters);
  /// Starts the fit again with something changed, recorded. @param settings  as parse_lesson() reads them.
  void begin_lesson(const std::string& settings);
  /// describe_lesson() of the last one, compared with the one with nothing changed.
  std::string lesson_report() const;

 private:
  bool holds(PipelineStage stage) const;
  void advance();
  void keep_result();
  void drop_findings();
  void drop_result();
  nlohmann::json paint(const nlohmann::json& request);
  const MeasuredRegistration& measured();
  std::string describe_files(std::vector<ExportedFile> files);
  nlohmann::json describe_pose();
  nlohmann::json describe_result() const;

  Task task_;
  ModelShelf models_;
  bool changing_models_ = false;  ///< what networks are asked for is the models'
  std::shared_ptr<const Scan> scan_;
  double read_ms_ = 0;
  DecimatedMesh shown_;  ///< for the view, relative to the scan's origin

  Settings settings_;
  std::unique_ptr<RegistrationPipeline> pipeline_;
  PipelineStage until_ = PipelineStage::fit;
  std::optional<NetworkRequest> request_;
  NetworkReply reply_;
  std::optional<Registration> registration_;
  std::unique_ptr<MeasuredRegistration> measured_;  ///< of registration_, when it was asked for
  Points3f standing_vertices_, seated_vertices_;
  Points3f body_vertices_;   ///< registered, body frame
  Points3f posed_vertices_;  ///< before the fit, body frame
  std::vector<ExportedFile> files_;
  PosedBody posed_;
  std::optional<Lesson> lesson_;
  std::optional<Lesson> unchanged_;  ///< the lesson with nothing changed, to compare with
  Editor editor_;
  Painter painter_;
};

}  // namespace vitruvian::wasm
