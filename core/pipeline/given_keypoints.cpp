#include "pipeline/given_keypoints.h"

#include <Eigen/Geometry>
#include <array>
#include <initializer_list>
#include <string_view>

#include "align/frame.h"
#include "base/error.h"
#include "keypoints/left_right.h"
#include "keypoints/smpl_joints.h"

namespace vitruvian {
namespace {

/// Cosine of the largest angle (30 degrees) at which the body's line counts as being along a scan axis.
constexpr double kAlongAxis = 0.866;

/// Mean of those of the joints that are known.
std::optional<Vec3d> mean_of(const KeypointSet& keypoints, std::initializer_list<const char*> names) {
  Vec3d sum = Vec3d::Zero();
  int count = 0;
  for (const char* name : names) {
    const auto found = keypoints.joints.find(name);
    if (found == keypoints.joints.end() || !(found->second.confidence > 0)) continue;
    sum += found->second.position;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::optional<Vec3d> standing_line(const KeypointSet& keypoints) {
  const auto upper = mean_of(keypoints, {"head", "neck", "left_collar", "right_collar", "left_shoulder",
                                         "right_shoulder", "spine3"});
  std::optional<Vec3d> lower =
      mean_of(keypoints, {"left_ankle", "right_ankle", "left_foot", "right_foot", "left_knee", "right_knee"});
  if (!lower) lower = mean_of(keypoints, {"pelvis", "left_hip", "right_hip"});
  if (!upper || !lower || !((*upper - *lower).norm() > 0)) return std::nullopt;
  return (*upper - *lower).normalized();
}

std::optional<Vec3d> to_the_left(const KeypointSet& keypoints) {
  Vec3d sum = Vec3d::Zero();
  for (const auto& [left, right] :
       {std::pair{"left_shoulder", "right_shoulder"}, std::pair{"left_hip", "right_hip"}}) {
    const auto a = mean_of(keypoints, {left}), b = mean_of(keypoints, {right});
    if (a && b) sum += *a - *b;
  }
  if (!(sum.norm() > 0)) return std::nullopt;
  return sum;
}

}  // namespace

Mat3d rotation_from_keypoints(const KeypointSet& keypoints, const std::optional<Vec3d>& up,
                              const std::optional<Vec3d>& front) {
  Vec3d upward;
  if (up) {
    upward = *up;
  } else if (const auto line = standing_line(keypoints)) {
    const Vec3d axis = axis_vector(nearest_axis(*line));
    upward = axis.dot(*line) > kAlongAxis ? axis : *line;
  } else {
    throw Error(
        ErrorCode::usage,
        "the keypoints do not tell what is up: place a joint of the chest or head and one of the hips "
        "or legs, or give --up");
  }
  std::optional<Vec3d> forward = front;
  if (!forward) {
    if (const auto left = to_the_left(keypoints)) {
      // Left x up is forward; nothing to go by when the body lies on its side.
      const Vec3d candidate = left->cross(upward);
      if (candidate.norm() > 0.1 * left->norm() * upward.norm()) forward = candidate;
    }
  }
  return body_from_scan_rotation(upward, forward);
}

std::vector<Keypoint> keypoints_in_body(const KeypointSet& keypoints, const Mat4d& body_from_scan) {
  const Mat3d body_from_canonical = canonical_from_body_rotation().transpose();
  const auto to_body = [&](const Vec3d& position) -> Vec3d {
    switch (keypoints.frame) {
      case KeypointFrame::scan:
        return body_from_scan.topLeftCorner<3, 3>() * position + body_from_scan.topRightCorner<3, 1>();
      case KeypointFrame::canonical:
        return body_from_canonical * position;
      case KeypointFrame::body:
        break;
    }
    return position;
  };
  std::vector<Keypoint> result;
  for (int j = 0; j < kSmplKeypointCount; ++j) {
    Keypoint keypoint;
    keypoint.joint = kSmplJointNames[j];
    const auto found = keypoints.joints.find(keypoint.joint);
    if (found != keypoints.joints.end()) {
      keypoint.position_m = to_body(found->second.position);
      keypoint.confidence = found->second.confidence;
      keypoint.source = KeypointSource::user;
    }
    result.push_back(std::move(keypoint));
  }
  return result;
}

PoseTargets pose_targets(const Models& models, const Settings& settings, const SeenLandmarks& seen,
                         const Mat4d& body_from_scan) {
  if (settings.keypoints) {
    std::vector<Keypoint> keypoints = keypoints_in_body(*settings.keypoints, body_from_scan);
    std::vector<LandmarkTarget> targets = joint_targets(keypoints);
    return {std::move(keypoints), std::move(targets)};
  }
  if (seen.swap_aware.empty()) return {keypoints_in_body({}, body_from_scan), {}};
  return {smpl_keypoints(seen.swap_aware), landmark_targets(models.landmarks, seen.swap_aware)};
}

std::vector<LandmarkTarget> joint_targets(const std::vector<Keypoint>& keypoints) {
  std::vector<LandmarkTarget> targets;
  for (int j = 0; j < static_cast<int>(keypoints.size()); ++j) {
    const Keypoint& k = keypoints[j];
    if (!k.position_m || !(k.confidence > 0)) continue;
    targets.push_back({LandmarkTarget::kJointItself, j, j, Vec3d::Zero(), *k.position_m, k.confidence});
  }
  return targets;
}

}  // namespace vitruvian
