#pragma once

#include <span>

#include "base/types.h"
#include "geometry/closest_point.h"
#include "geometry/kdtree.h"

namespace vitruvian {

/// The whole scan, body frame, metres. Refers to the caller's arrays.
struct ScanSurface {
  const Points3f& points;   ///< 3 x N, finite, N > 0
  const Points3f& normals;  ///< 3 x N, unit, outward; a zero column: unknown, compatible with anything
  const Faces& faces;       ///< 3 x F; 3 x 0 for a bare point cloud
  const KdTree& tree;       ///< 3-D tree of the body's `points`
  /// Closest points on the triangles; null for a bare point cloud, whose surface is then taken to be the
  /// local plane of the nearest points.
  const ClosestPointOnMesh* mesh;
  /// Indices of the points that are the body's, in rising order; empty: all. `faces`, `tree` and `mesh` hold
  /// no others.
  std::span<const int> body = {};
};

}  // namespace vitruvian
