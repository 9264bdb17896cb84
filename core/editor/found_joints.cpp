#include "editor/found_joints.h"

#include "fit/landmark_fit.h"

namespace vitruvian {
namespace {

/// The landmark that lies nearest to a joint; null when none of it was seen.
const LandmarkTarget* nearest_landmark(const std::vector<LandmarkTarget>& targets, int joint) {
  const LandmarkTarget* nearest = nullptr;
  for (const LandmarkTarget& l : targets) {
    if (l.joint != joint || l.landmark == LandmarkTarget::kJointItself || !(l.weight > 0)) continue;
    if (!nearest || l.offset.squaredNorm() < nearest->offset.squaredNorm()) nearest = &l;
  }
  return nearest;
}

}  // namespace

std::vector<Keypoint> joints_of_model(const FitModel& model, const PoseTargets& seen) {
  std::vector<Keypoint> keypoints = seen.keypoints;
  if (seen.targets.empty()) return keypoints;
  const Skeleton skeleton = pose_skeleton(model.body, fit_landmarks(model, seen.targets));
  for (int j = 0; j < static_cast<int>(keypoints.size()) && j < skeleton.joints.cols(); ++j) {
    Keypoint& keypoint = keypoints[static_cast<std::size_t>(j)];
    if (!keypoint.position_m) continue;
    if (keypoint.source == KeypointSource::derived) keypoint.position_m = skeleton.joints.col(j);
    if (keypoint.source != KeypointSource::detected) continue;
    if (const LandmarkTarget* landmark = nearest_landmark(seen.targets, j)) {
      const Vec3d joint = skeleton.joints.col(j);
      keypoint.position_m = joint + landmark->target - landmark_position(skeleton, *landmark);
    }
  }
  return keypoints;
}

}  // namespace vitruvian
