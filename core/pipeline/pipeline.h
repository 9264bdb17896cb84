#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "align/units.h"
#include "align/up_detector.h"
#include "fit/hypotheses.h"
#include "fit/region_labels.h"
#include "keypoints/network.h"
#include "pipeline/attempt.h"
#include "pipeline/crop.h"
#include "pipeline/given_keypoints.h"
#include "pipeline/landmark_stage.h"
#include "pipeline/models.h"
#include "pipeline/paper_pipeline.h"
#include "pipeline/prepared_scan.h"
#include "pipeline/registration.h"
#include "pipeline/stage.h"

namespace vitruvian {

/// The registration of one scan as a sequence of stages. Networks are run by whoever owns the object,
/// natively or in the page:
///
///   RegistrationPipeline pipeline(models, settings, execution);
///   pipeline.set_scan(std::move(scan));
///   while (auto request = pipeline.next_request()) pipeline.accept(run(*request));
///   const Registration result = pipeline.finish();
///
/// next_request() does the work between two requests: pictures, triangulation, and the fit of a finished
/// hypothesis. It can stop after an earlier stage, whose finding is then there to look at; settings can be
/// changed before going on, and only the stages that they touch are worked again:
///
///   while (auto request = pipeline.next_request(PipelineStage::align)) pipeline.accept(run(*request));
///   show(pipeline.align_finding());
///   settings.front = Axis::x;
///   pipeline.configure(settings);
///
/// Stepping leads to the same result as going through at once, byte for byte.
class RegistrationPipeline {
 public:
  /// @param models, execution  must outlive the object.
  /// @throws Error(usage) when settings contradict each other, Error(not_available) for methods not offered.
  RegistrationPipeline(const Models& models, const Settings& settings, const Execution& execution);
  ~RegistrationPipeline();

  /// @throws Error(no_geometry), Error(cancelled).
  void set_scan(Scan scan) { set_scan(std::make_shared<const Scan>(std::move(scan))); }
  void set_scan(std::shared_ptr<const Scan> scan);
  bool has_scan() const { return whole_ != nullptr; }
  /// @param read_ms  time spent on reading the file, for the report.
  void set_read_time(double read_ms) { read_ms_ = read_ms; }

  /// Whom to tell each iteration's energy while the published solver works (on the working thread).
  void on_energy(EnergyTrace trace) { energy_ = std::move(trace); }

  /// Takes other settings over and forgets the stages that they can alter. @throws as the constructor, with
  /// nothing changed.
  void configure(const Settings& settings);
  /// Forgets `stage` and all later ones, so that they are worked again. After a cancel or an error: forgets
  /// what the stage under way had done when given that stage.
  void forget(PipelineStage stage);

  /// @param until  the last stage to work.
  /// @return nothing when that stage is reached.
  std::optional<NetworkRequest> next_request(PipelineStage until = PipelineStage::fit);
  /// Takes the answer to the current request. @throws Error(internal) when nothing is asked or the reply does
  /// not fit.
  void accept(const NetworkReply& reply);
  /// Refinement, errors, verdict. After the fit has been reached; gives the same each time, but for times.
  /// @throws Error(internal) before that.
  Registration finish();

  bool reached(PipelineStage stage) const;

  /// What align found; after the fit, what the fit decided.
  struct AlignFinding {
    Alignment alignment;
    double height_m;        ///< extent of the scan along the body's up, floor and strays left out
    bool front_is_known;    ///< false: nothing tells front from back, the heading is arbitrary
    std::string unit_note;  ///< plain words when another unit is possible too, else empty
  };
  /// @throws Error(internal) before align is reached.
  AlignFinding align_finding() const;
  /// Pictures, and what was seen in them, of the placement at work or, after the fit, of the best; null
  /// before there are any.
  const LandmarkStage* landmark_stage() const;
  /// The 22 joints of the contract, body frame. @throws Error(internal) before keypoints are reached.
  std::vector<Keypoint> keypoints() const;
  /// The body that the fit starts from, body frame. @throws Error(internal) before the pose is reached.
  const BodyState& initial_pose() const;

  /// What the fit is to meet, in the frame of align_finding(). @throws Error(internal) before keypoints.
  PoseTargets targets() const;

  const Settings& settings() const { return settings_; }
  const FitModel& fit_model() const { return *fit_model_; }
  /// What is left of the scan after cropping. Valid after set_scan(), until crops are changed.
  const PreparedScan& prepared() const { return *scan_; }

 private:
  /// A placement that was fitted.
  struct Candidate {
    std::size_t attempt = 0;
    Mat4d body_from_scan;
    UnitCandidate unit;
    SeenLandmarks landmarks;  // body frame
    PoseTargets seen;
    BodyState initial;  // posed by them alone, or given
    HypothesisResult fit;
    double stature = 0;  // m, of the fitted body, standing
  };
  /// The search for the best placement and unit.
  struct Search {
    std::size_t at = 0;  // the attempt at work
    int refit_budget;    // surface fits that are left for all of them, beyond their first ones
    std::optional<Candidate> best;
    bool done = false;

    Search();
  };

  void prepare();
  std::optional<NetworkRequest> work(PipelineStage until);
  bool find_placements(std::optional<NetworkRequest>& request);
  AttemptContext context();
  void choose_units();
  void fit_attempt();
  /// @param quick  without searching for misplaced limbs or other starts.
  Candidate fit_candidate(std::size_t attempt, const UnitCandidate& unit, bool quick);
  double rank(const Candidate& candidate) const;
  void fit_as_published(Candidate& candidate);
  const Attempt& shown() const;
  const UnitCandidate& shown_unit() const;
  void require(PipelineStage stage) const;

  const Models& models_;
  Settings settings_;
  const Execution& execution_;
  std::unique_ptr<FitModel> fit_model_;

  std::shared_ptr<const Scan> whole_;   // as it was set
  CroppedScan source_;                  // what the crops leave of it
  std::unique_ptr<PreparedScan> scan_;  // of that; none when the crops were changed
  std::unique_ptr<ViewSurface> detector_surface_;
  std::unique_ptr<UpDetector> up_detector_;  // knows the scan alone: no setting makes it look again
  UnitGuess units_;
  RegionLabels regions_;
  std::vector<Attempt> attempts_;
  Search search_;

  EnergyTrace energy_;
  StageClock clock_;
  double read_ms_ = 0;
};

/// One-shot registration with a function that runs the networks.
Registration register_scan(Scan scan, const Models& models, const Settings& settings,
                           const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                           const Execution& execution, double read_ms = 0);

}  // namespace vitruvian
