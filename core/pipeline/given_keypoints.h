#pragma once

#include <optional>
#include <vector>

#include "fit/normal_equations.h"
#include "pipeline/edits.h"
#include "pipeline/landmark_stage.h"
#include "pipeline/models.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// Rotation scan -> body that follows from joints in the scan frame: up is the scan axis nearest to the line
/// from the lower joints (feet to hips) to the upper ones (chest to head), or that line itself where no axis
/// is near; left and right sides give the front.
/// @param up, front  scan axes, where they are known.
/// @throws Error(usage) when the joints do not tell what is up and `up` is not given.
Mat3d rotation_from_keypoints(const KeypointSet& keypoints, const std::optional<Vec3d>& up,
                              const std::optional<Vec3d>& front);

/// The 22 joints in the body frame, SMPL order; those that are missing have no position.
/// @param body_from_scan  unit factor included; used for the scan frame only.
std::vector<Keypoint> keypoints_in_body(const KeypointSet& keypoints, const Mat4d& body_from_scan);

/// What a fit is to meet, body frame.
struct PoseTargets {
  std::vector<Keypoint> keypoints;      ///< 22
  std::vector<LandmarkTarget> targets;  ///< keypoints placed by hand, else landmarks by the calibration
};

/// @param seen  body frame; empty lists when nothing was looked for.
PoseTargets pose_targets(const Models& models, const Settings& settings, const SeenLandmarks& seen,
                         const Mat4d& body_from_scan);

/// Targets for a fit: each known joint at its own place, weighted by its confidence.
std::vector<LandmarkTarget> joint_targets(const std::vector<Keypoint>& keypoints);

}  // namespace vitruvian
