#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"
#include "measure/surface_error.h"
#include "measure/verdict.h"
#include "measure/verdict_features.h"
#include "pipeline/models.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// How a scan lies in the body frame (contract.md "Frames and units").
struct Alignment {
  Mat4d body_from_scan = Mat4d::Identity();  ///< unit factor included
  Mat4d canonical_from_body = Mat4d::Identity();
  Unit unit = Unit::metre;
  double metres_per_unit = 1;
  std::string up, front;  ///< scan axis nearest to the body's up and front, e.g. "z", "-y"
  std::string method;     ///< how it was found, e.g. "views", "given", "pca"
};

enum class KeypointSource { detected, derived, user, none };
std::string to_string(KeypointSource source);

/// One of the 22 SMPL joints as seen before fitting.
struct Keypoint {
  std::string joint;
  std::optional<Vec3d> position_m;  ///< body frame
  double confidence = 0;
  KeypointSource source = KeypointSource::none;
};

/// Name of the file of vertex offsets beside registration.json.
constexpr const char* kOffsetsFile = "offsets.npz";

struct RegisteredJoint {
  std::string name;
  Vec3d body_m;
  Vec3d scan;  ///< scan frame, scan units
};

struct ScanInfo {
  std::string file, sha256;
  long vertices = 0, faces = 0;
};

struct ModelInfo {
  std::string name, family, sha256;
  Gender gender = Gender::neutral;
  int vertices = 0, faces = 0, betas = 0, joints = 0;
  std::optional<FileInfo> dmpl, prior;  ///< files of the user's besides the model's
};

/// Milliseconds by stage; a stage that was not run is 0.
struct Timing {
  double read = 0, align = 0, project = 0, detect = 0, pose = 0, fit = 0, refine = 0, detail = 0, write = 0,
         total = 0;
};

/// The result of registering one scan; everything that registration.json holds, and the mesh.
struct Registration {
  ScanInfo scan;
  ModelInfo model;
  Alignment alignment;
  std::vector<Keypoint> keypoints;           ///< 22
  std::optional<BodyParameters> parameters;  ///< none when failed before a fit
  std::vector<RegisteredJoint> joints;
  std::optional<SurfaceError> surface_error;
  std::optional<SurfaceError> parametric_error;  ///< before vertex offsets were added; none without offsets
  Verdict verdict;
  std::optional<VerdictFeatures>
      verdict_features;  ///< what it was judged from; none when failed before a fit
  Timing timing_ms;
  Settings settings;

  Points3d registered_vertices;  ///< 3 x V, scan frame and scan units; empty when failed
  Faces registered_faces;
  Points3f offsets;  ///< 3 x V, m, rest frame, before skinning; empty without --detail vertex
  std::vector<float> vertex_error_mm;  ///< V, distance to the scan's surface; empty when failed
};

}  // namespace vitruvian
