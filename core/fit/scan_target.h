#pragma once

#include "base/execution.h"
#include "geometry/closest_point.h"
#include "geometry/kdtree.h"
#include "geometry/mesh.h"

namespace vitruvian {

/// The scan as the fit sees it: body frame, metres, points spread evenly over the surface in random order, so
/// that any prefix is an even, coarser sampling.
struct ScanTarget {
  /// Metres that a turned normal counts in the six-dimensional neighbour search.
  static constexpr float kNormalWeight = 0.05f;

  Points3f points;
  Points3f normals;
  KdTree by_position;
  KdTree by_position_and_normal;

  /// @param vertices, faces, normals  the scan, body frame, metres; without faces the vertices are the
  /// samples.
  /// @param count  number of points wanted.
  static ScanTarget sample(const Points3f& vertices, const Faces& faces, const Points3f& normals, int count,
                           std::uint32_t seed);
  static ScanTarget from_points(Points3f points, Points3f normals);
};

}  // namespace vitruvian
