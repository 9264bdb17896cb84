#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Which points of a scan belong to the body.
struct BodyPoints {
  std::vector<std::uint8_t> keep;  ///< V, 1 for the body's points
  long strays = 0;  ///< points removed because they lie apart in small groups, or are not finite
  long floor = 0;   ///< points removed because they lie on a floor or wall
};

/// Leaves out stray points and a floor: a plane that holds a tenth or more of the surface, spreads wider than
/// a pair of feet, and has (almost) everything else on one side. Judged by occupied cells of a grid, so
/// uneven sampling does not matter. Any unit. Deterministic.
BodyPoints find_body_points(const Points3f& vertices);

/// Largest distance between two kept points, to about half a per cent. 0 when none is kept.
double diameter(const Points3f& vertices, const BodyPoints& body);

/// Centre of the body, the origin of the body frame: area-weighted mean of the triangles with all corners
/// kept; mean of the kept points when there are no such triangles. Unit and frame of the vertices.
Vec3d centroid(const Points3f& vertices, const Faces& faces, const BodyPoints& body);

}  // namespace vitruvian
