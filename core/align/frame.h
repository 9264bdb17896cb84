#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/types.h"
#include "keypoints/view.h"

namespace vitruvian {

/// Rotation from the scan's axes to body axes (Y up, facing +Z, left on +X).
/// @param up     scan axes, any length.
/// @param front  scan axes; made orthogonal to `up`. Without it the yaw is arbitrary but reproducible: the
/// scan axis
///               among z, x, y that is least parallel to `up` becomes the front.
/// @throws Error(usage) when up is zero or front is parallel to up.
Mat3d body_from_scan_rotation(const Vec3d& up, const std::optional<Vec3d>& front = std::nullopt);

/// Whole transform: metres, rotated, `centroid_scan` at the origin.
Mat4d body_from_scan(const Mat3d& rotation, const Vec3d& centroid_scan, double metres_per_unit);

/// The same transform followed by a turn about the body frame's Y axis that brings the facing direction
/// (sin yaw, 0, cos yaw) to +Z.
Mat4d facing_forward(const Mat4d& body_from_scan, double yaw);
void turn_forward(std::vector<Landmark3d>& landmarks_body, double yaw);

/// Horizontal direction that a body faces, and how sure that is.
struct Facing {
  double yaw;         ///< radians; the body faces (sin yaw, 0, cos yaw)
  double confidence;  ///< 0..1; low when shoulders, hips and nose contradict each other or are hardly seen
};

/// Facing from the triangulated shoulders, hips, nose and ears: the chest's direction is (right to left) x
/// (hips to shoulders). A body that lies on its back or front, chest up or down, is turned as if it had
/// fallen from standing.
/// @param landmarks  33, in a frame with Y up.
/// @return nothing when shoulders and hips are unknown or coincide.
std::optional<Facing> yaw_from_landmarks(std::span<const Landmark3d> landmarks);

/// Signed scan axis nearest to a direction in scan axes: "x", "-x", "y", "-y", "z", "-z".
std::string nearest_axis(const Vec3d& direction_scan);
/// Inverse of nearest_axis. @throws Error(usage) for any other word.
Vec3d axis_vector(std::string_view name);

/// Rotation of the paper's PCA alignment (section 3.1.1): first and second principal directions of the scan
/// onto those of the template, third by the cross product. The first direction's sign is the one that makes
/// its largest scan coordinate positive; the remaining half turn about it is chosen so that the points'
/// skewness along the template's third direction has the template's sign. Lying, sitting and arms-up bodies
/// may come out wrong: that is the method.
/// @param scan_points      scan axes.
/// @param template_points  body frame.
/// @return rotation from scan axes to body axes.  @throws Error(no_geometry) with fewer than 4 points.
Mat3d align_pca(const Points3f& scan_points, const Points3f& template_points);

}  // namespace vitruvian
