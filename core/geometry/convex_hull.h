#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Why a point set has no hull of positive volume.
enum class HullDefect { none, too_few_points, coincident, collinear, coplanar };
/// In plain words, e.g. "all points lie on one plane"; empty for none.
std::string_view describe(HullDefect defect) noexcept;

/// Convex hull of points in space.
struct ConvexHull {
  std::vector<std::array<int, 3>> faces;  ///< indices into the points, counter-clockwise seen from outside
  double volume = 0;                      ///< 0 when there is a defect
  double area = 0;                        ///< of the surface; 0 when there is a defect
  HullDefect defect = HullDefect::none;
};

/// Exact in its decisions: points are snapped to a grid of 2^-24 of their extent, where orientation is
/// decided in integers, so the result is the same on every platform. Point sets thinner than 1e-6 of their
/// extent count as degenerate. Volume and area are of the points as given. O(points x hull faces).
/// @throws Error(internal) when a coordinate is not finite.
ConvexHull convex_hull(const Points3d& points);

using Points2d = Eigen::Matrix<double, 2, Eigen::Dynamic>;

/// Convex hull of points in the plane: their indices, counter-clockwise, no collinear ones. Fewer than three
/// when the points are coincident or collinear.
std::vector<int> convex_hull_2d(const Points2d& points);

/// Signed area (shoelace, positive when counter-clockwise) and length of a closed polygon.
double polygon_area(const Points2d& polygon);
double polygon_perimeter(const Points2d& polygon);

}  // namespace vitruvian
