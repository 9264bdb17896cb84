#pragma once

#include <optional>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// A line through the scan, in the frame and units of the points it is used with.
struct LineOfSight {
  Vec3d origin = Vec3d::Zero();
  Vec3d direction = Vec3d::UnitZ();  ///< any length above 0

  Vec3d at(double distance) const { return origin + distance * direction.normalized(); }
};

/// Distances along a line at which it passes through a surface, increasing; those nearer to each other than
/// `merge` count once. Of a bare point cloud: middles of the groups of points within `merge` of the line.
/// @param vertices  3 x N; @param faces  3 x F, or none for a point cloud.
std::vector<double> crossings(const Points3f& vertices, const Faces& faces, const LineOfSight& line,
                              double merge);

/// Middle of the body along a line of sight: of the part between entry and exit whose middle lies nearest to
/// `distance_now`. Nothing where the line misses the body, or where no part is at most 0.32 m thick: there
/// (the trunk seen from the side, limbs behind one another) the middle of what is seen is not a joint's
/// place.
/// @param metres_per_unit  of the vertices' frame.
std::optional<Vec3d> middle_of_body(const Points3f& vertices, const Faces& faces, const LineOfSight& line,
                                    double distance_now, double metres_per_unit);

}  // namespace vitruvian
