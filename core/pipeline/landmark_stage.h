#pragma once

#include <optional>
#include <vector>

#include "fit/normal_equations.h"
#include "keypoints/triangulation.h"
#include "keypoints/view_landmarks.h"
#include "keypoints/views.h"
#include "pipeline/models.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// Landmarks of one scan under one assumption of what is up, in the frame they were seen in (Y up, unknown
/// heading).
struct SeenLandmarks {
  std::vector<Landmark3d> swap_aware;  ///< 33; left and right exchanged where views contradict each other
  std::vector<Landmark3d> plain;       ///< 33; labels as the network gave them; empty in two-view mode
  double presence = 0;                 ///< mean certainty of the network that there is a body
};

/// Stages "project" and "detect": pictures of the upright scan, landmarks in each, and their positions in
/// space. Requests are answered from outside: while (auto r = stage.next_request()) stage.accept(run(*r)).
class LandmarkStage {
 public:
  /// @param upright  scan with Y up, metres.
  /// @param views    2: front and side as published, of a body that faces +Z; more: a ring round the body.
  /// @param trunk    direction from hips to head in that frame, roughly: pictures are taken upright along it.
  LandmarkStage(const ViewSurface& upright, const Vec3d& trunk, int views, double min_visibility,
                const Execution& execution);

  std::optional<NetworkRequest> next_request() const { return detector_->next_request(); }
  void accept(const NetworkReply& reply) { detector_->accept(reply); }
  /// After the last reply.
  SeenLandmarks result() const;

  const std::vector<View>& views() const { return views_; }
  const std::vector<ViewLandmarks>& view_landmarks() const { return detector_->result(); }

 private:
  double min_visibility_;
  std::vector<Camera> cameras_;
  std::vector<View> views_;
  std::optional<ViewLandmarkDetector> detector_;
};

/// Targets for a fit from landmarks in the body frame, by the model's calibration.
std::vector<LandmarkTarget> landmark_targets(const std::vector<LandmarkOffset>& offsets,
                                             const std::vector<Landmark3d>& landmarks);

/// The 22 joints of the contract from landmarks in the body frame (appendix A).
std::vector<Keypoint> smpl_keypoints(const std::vector<Landmark3d>& landmarks);

}  // namespace vitruvian
