#pragma once

#include "align/units.h"
#include "body/forward.h"
#include "fit/fit_model.h"
#include "pipeline/given_keypoints.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// Mean shape in the rest pose with its surface's centroid at a point of the body frame: the start of the
/// paper's appendix C (ablation), beta_0 = 0, theta_0 = 0.
BodyState rest_pose_at(const FitModel& model, const Vec3d& centroid);

/// State of given parameters; betas that the fit does not have are dropped, those it has more are 0.
BodyState state_of(const FitModel& model, const BodyParameters& parameters);

/// Whether a start was given, so that no other is to be tried: keypoints placed by hand, the published
/// inverse kinematics, the rest pose or an earlier body.
bool start_is_given(const Settings& settings);

/// Where the fit starts: the published inverse kinematics on the keypoints (InitMode::keypoints; with fewer
/// than three of them the rest pose), the rest pose, an earlier body, or our own inverse kinematics.
/// @param centroid  of the scan, body frame.
BodyState initial_pose(const FitModel& model, const Settings& settings, const PoseTargets& seen,
                       const Vec3d& centroid, const Execution& execution);

/// A point under a transform.
inline Vec3d transformed(const Mat4d& transform, const Vec3d& point) {
  return transform.topLeftCorner<3, 3>() * point + transform.topRightCorner<3, 1>();
}

/// Rotation of a similarity.
Mat3d rotation_of(const Mat4d& similarity);

/// Unit that a given transform implies: the known one within 0.1 % of its factor, else one without a name.
UnitCandidate unit_of(const Mat4d& body_from_scan, double extent);

}  // namespace vitruvian
