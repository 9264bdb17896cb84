#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "align/units.h"
#include "align/up_detector.h"
#include "fit/hypotheses.h"
#include "keypoints/network.h"
#include "pipeline/landmark_stage.h"
#include "pipeline/models.h"
#include "pipeline/prepared_scan.h"
#include "pipeline/registration.h"

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
/// hypothesis.
class RegistrationPipeline {
 public:
  /// @param models, execution  must outlive the object.
  /// @throws Error(usage) when settings contradict each other, Error(not_available) for methods not offered.
  RegistrationPipeline(const Models& models, const Settings& settings, const Execution& execution);
  ~RegistrationPipeline();

  /// @throws Error(no_geometry).
  void set_scan(Scan scan);
  /// @param read_ms  time spent on reading the file, for the report.
  void set_read_time(double read_ms) { timing_.read = read_ms; }

  std::optional<NetworkRequest> next_request();
  void accept(const NetworkReply& reply);
  /// Last stages: refinement, errors, verdict. Call once, after next_request() has returned nothing.
  Registration finish();

  /// What the stages saw, for display. Valid after set_scan(); landmarks once seen.
  const PreparedScan& prepared() const { return *scan_; }
  const LandmarkStage* landmark_stage() const { return landmark_stage_.get(); }

 private:
  /// One assumption of how the scan lies.
  struct Placement {
    Mat3d rotation;  // upright_from_scan, any heading
    Vec3d trunk;     // upright frame: direction along which the pictures are upright
    std::string method;
    bool facing_known = false;
  };
  /// A placement that was looked at and fitted.
  struct Candidate {
    Mat4d body_from_scan;
    UnitCandidate unit;
    std::string method;
    SeenLandmarks landmarks;  // body frame
    HypothesisResult fit;
    double stature = 0;  // m, of the fitted body, standing
  };

  using Clock = std::chrono::steady_clock;
  void start_stage(double Timing::*stage);
  void begin_placements();
  void begin_views();
  bool needs_facing() const;
  void fit_placement();
  /// @param quick  without searching for misplaced limbs or other starts.
  Candidate fit_candidate(const Placement& placement, const UnitCandidate& unit, SeenLandmarks seen,
                          bool quick);
  double rank(const Candidate& candidate) const;

  const Models& models_;
  Settings settings_;
  const Execution& execution_;
  std::unique_ptr<FitModel> fit_model_;

  std::unique_ptr<PreparedScan> scan_;
  std::unique_ptr<ViewSurface> detector_surface_;
  std::unique_ptr<UpDetector> up_detector_;
  std::unique_ptr<LandmarkStage> landmark_stage_;
  UnitGuess units_;
  std::vector<Placement> placements_;
  std::size_t placement_ = 0;
  std::optional<Candidate> best_;
  int refit_budget_ = 0;
  bool finished_ = false;

  Timing timing_;
  double Timing::*current_stage_ = nullptr;
  Clock::time_point stage_began_, began_;
};

/// One-shot registration with a function that runs the networks.
Registration register_scan(Scan scan, const Models& models, const Settings& settings,
                           const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                           const Execution& execution, double read_ms = 0);

}  // namespace vitruvian
