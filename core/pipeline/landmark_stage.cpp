#include "pipeline/landmark_stage.h"

#include <algorithm>

#include "keypoints/left_right.h"
#include "keypoints/smpl_joints.h"

namespace vitruvian {
namespace {

// Agreement of the rays at which a landmark counts fully, and the least and most that its residual can
// change.
constexpr double kGoodResidual = 0.03, kBestResidual = 0.01, kLeastTrust = 0.15;

Keypoint to_keypoint(const SmplKeypoint& joint, std::string_view name) {
  Keypoint keypoint;
  keypoint.joint = name;
  switch (joint.source) {
    case JointSource::detected:
      keypoint.source = KeypointSource::detected;
      break;
    case JointSource::derived:
      keypoint.source = KeypointSource::derived;
      break;
    case JointSource::none:
      keypoint.source = KeypointSource::none;
      break;
  }
  if (joint.source != JointSource::none) {
    keypoint.position_m = joint.position;
    keypoint.confidence = joint.confidence;
  }
  return keypoint;
}

}  // namespace

LandmarkStage::LandmarkStage(const ViewSurface& upright, const Vec3d& trunk, int views, double min_visibility,
                             const Execution& execution)
    : min_visibility_(min_visibility) {
  const Framing framing;
  if (views == 2) {
    const auto cameras = paper_cameras(upright.vertices, framing);
    cameras_.assign(cameras.begin(), cameras.end());
  } else {
    cameras_ = ring_cameras(upright.vertices, views, framing, trunk.cast<float>());
  }
  views_ = render_views(upright, cameras_, ViewStyle(), execution);
  detector_.emplace(views_);
}

SeenLandmarks LandmarkStage::result() const {
  SeenLandmarks seen;
  const std::vector<ViewLandmarks>& views = detector_->result();
  for (const ViewLandmarks& view : views)
    seen.presence += view.body_presence / static_cast<double>(views.size());
  if (views.size() == 2) {
    seen.swap_aware =
        lift_two_views(cameras_[0], views[0], cameras_[1], views[1], VisibilityRule::mean, min_visibility_);
    correct_left_right(seen.swap_aware);
    return seen;
  }
  TriangulationSettings triangulation;
  triangulation.min_visibility = min_visibility_;
  seen.swap_aware = triangulate(cameras_, views, triangulation).landmarks;
  triangulation.find_swaps = false;
  seen.plain = triangulate(cameras_, views, triangulation).landmarks;
  return seen;
}

std::vector<LandmarkTarget> landmark_targets(const std::vector<LandmarkOffset>& offsets,
                                             const std::vector<Landmark3d>& landmarks) {
  std::vector<LandmarkTarget> targets;
  for (const LandmarkOffset& offset : offsets) {
    const Landmark3d& seen = landmarks[offset.landmark];
    const double agreement =
        std::clamp(kGoodResidual / std::max<double>(seen.residual, kBestResidual), kLeastTrust, 1.0);
    targets.push_back({offset.landmark, offset.joint, offset.frame_joint, offset.offset,
                       seen.position.cast<double>(), seen.confidence > 0 ? offset.weight * agreement : 0});
  }
  return targets;
}

std::vector<Keypoint> smpl_keypoints(const std::vector<Landmark3d>& landmarks) {
  std::vector<Keypoint> keypoints;
  const auto joints = smpl_joints(landmarks, SmplJointSettings());
  for (std::size_t j = 0; j < joints.size(); ++j)
    keypoints.push_back(to_keypoint(joints[j], kSmplJointNames[j]));
  return keypoints;
}

}  // namespace vitruvian
