#pragma once

#include <memory>
#include <optional>

#include "align/units.h"
#include "body/forward.h"
#include "fit/fit_model.h"
#include "pipeline/landmark_stage.h"
#include "pipeline/models.h"
#include "pipeline/placement.h"
#include "pipeline/prepared_scan.h"
#include "pipeline/stage.h"

namespace vitruvian {

/// What an attempt works with.
struct AttemptContext {
  const Models& models;
  const FitModel& fit_model;
  const Settings& settings;
  const PreparedScan& scan;
  const UnitCandidate& unit;  ///< in which the scan is looked at
  const Execution& execution;
  StageClock& clock;
};

/// One placement taken through the stages before the fit: where the body faces, pictures and landmarks, the
/// pose that the landmarks alone suggest. Networks are run from outside, as for the whole pipeline.
class Attempt {
 public:
  explicit Attempt(Placement placement) : placement_(std::move(placement)) {}

  /// Works until `until` is reached (at most the pose) or a network has to be run.
  std::optional<NetworkRequest> next_request(PipelineStage until, const AttemptContext& context);
  /// @throws Error(internal) when nothing is asked or the reply does not fit.
  void accept(const NetworkReply& reply);
  /// Forgets `stage` and all later ones.
  void forget(PipelineStage stage);
  bool reached(PipelineStage stage) const;

  const std::string& method() const { return placement_.method; }
  /// As far as is known, after align.
  Mat4d body_from_scan(const Vec3d& centroid_scan, double metres_per_unit) const;
  /// Whether the way that the body faces was seen or given. After align.
  bool front_is_known() const { return front_is_known_; }
  /// Body frame, metres of the unit in the context. After keypoints.
  const SeenLandmarks& landmarks() const { return *landmarks_; }
  /// Pictures and what was seen in each; null before there are any.
  const LandmarkStage* pictures() const { return look_ ? &look_->stage : nullptr; }
  /// After pose.
  const BodyState& pose() const { return *pose_; }

 private:
  /// Upright frame of the pictures, and the turn about its Y axis that makes the body face +Z.
  struct Heading {
    Mat3d rotation;  // upright_from_scan
    std::optional<double> yaw;
  };
  struct Look {
    LandmarkStage stage;
    int views;
    Mat3d rotation;  // upright_from_scan
    std::optional<SeenLandmarks> seen;
  };

  void look(int views, const Mat3d& rotation, const AttemptContext& context);
  void align(const AttemptContext& context);
  void find_keypoints(const AttemptContext& context);

  Placement placement_;
  std::unique_ptr<Look> look_;
  std::optional<Heading> aligned_;  // after align
  bool front_is_known_ = false;
  std::optional<Heading> seen_;  // after keypoints
  std::optional<SeenLandmarks> landmarks_;
  std::optional<BodyState> pose_;
};

}  // namespace vitruvian
