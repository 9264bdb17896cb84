#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/types.h"
#include "keypoints/view.h"

namespace vitruvian {

/// Landmarks of one limb group whose left and right labels are exchanged together in a view.
enum class LimbGroup { legs = 0, arms = 1, torso = 2 };
constexpr int kLimbGroupCount = 3;

struct TriangulationSettings {
  /// Find, for each limb group, in which views the network took left for right.
  bool find_swaps = true;
  double swap_penalty = 0.25;  ///< cost of exchanging labels in all views, in units of log(1 + (e / scale)^2)
  double anatomy = 1.0;        ///< weight of joints lying on the wrong side against the majority of the views
  double scale = 0.03;         ///< Cauchy kernel, metres
  double start_scale = 0.15;   ///< of its first iteration
  int iterations = 6;
  double least_weight = 0.05;   ///< weight of a landmark that is not visible at all
  double min_visibility = 0.0;  ///< observations below it are not used
};

struct Triangulation {
  std::vector<Landmark3d> landmarks;  ///< 33, frame of the cameras
  /// For each limb group and view, whether left and right were exchanged in it.
  std::array<std::vector<std::uint8_t>, kLimbGroupCount> swapped;
};

/// Landmarks in space from 2 to 32 orthographic views: iteratively reweighted least squares with a Cauchy
/// kernel, visibility as a soft weight. With `find_swaps`, all assignments of left and right to the views are
/// tried for legs, arms and torso apart (up to 10 views; beyond that, those wrong in one arc of views, then
/// single changes), because the network errs mostly by exchanging the two. Which of the two is left then
/// follows from the majority of the views and from anatomy: chest and nose face the same way, knees and
/// elbows are near their own side.
/// @throws Error(internal) when sizes do not match or there are not 2..32 views.
Triangulation triangulate(std::span<const Camera> cameras, std::span<const ViewLandmarks> views,
                          const TriangulationSettings& settings);

/// How the visibilities of the two published views become one.
enum class VisibilityRule { mean, minimum, product };

/// The paper's lift (section 3.1.3): lateral and vertical coordinate from the front view, anterior from the
/// side view. The front picture is a true one, seen from canonical +Y, so columns grow with -X: x = x_max - u
/// (x_max - x_min). Landmarks whose combined visibility is below `min_visibility` get confidence 0. Residual:
/// difference of the two vertical coordinates.
/// @param front, side  as made by paper_cameras().
/// @return 33 landmarks in the body frame of the cameras.
std::vector<Landmark3d> lift_two_views(const Camera& front, const ViewLandmarks& front_view,
                                       const Camera& side, const ViewLandmarks& side_view,
                                       VisibilityRule rule, double min_visibility);

}  // namespace vitruvian
