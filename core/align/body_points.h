#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "geometry/mesh.h"

namespace vitruvian {

/// Which points of a scan belong to the body.
struct BodyPoints {
  std::vector<std::uint8_t> keep;  ///< V, 1 for the body's points
  long strays = 0;  ///< points removed because they lie apart in small groups, or are not finite
  long floor = 0;   ///< points removed because they lie on a floor or wall
  /// The floor's plane: its points p have floor_normal . p = floor_offset; the normal, toward the body, is
  /// zero when there is no floor. Points nearer to it than `floor_noise` belong to it.
  Vec3d floor_normal = Vec3d::Zero();
  double floor_offset = 0, floor_noise = 0;

  bool has_floor() const { return floor_normal.squaredNorm() > 0; }
  /// Whether a point lies on the floor or behind it.
  bool on_floor(const Vec3d& point) const {
    return has_floor() && floor_normal.dot(point) - floor_offset < floor_noise;
  }
};

/// Leaves out stray points and a floor: a plane that holds a tenth or more of the surface, spreads wider than
/// a pair of feet, and has (almost) everything else on one side. Judged by occupied cells of a grid, so
/// uneven sampling does not matter. Any unit. Deterministic.
/// @param faces  if there are any: what they connect is not parted.
BodyPoints find_body_points(const Points3f& vertices, const Faces& faces = Faces(3, 0));

/// The mesh or cloud without the points left out; a triangle that loses a corner goes too. `source` keeps its
/// meaning.
DecimatedMesh only_body(const DecimatedMesh& mesh, const BodyPoints& body);

/// Largest distance between two kept points, to about a tenth of a per cent. 0 when none is kept.
double diameter(const Points3f& vertices, const BodyPoints& body);

/// Centre of the body, the origin of the body frame: area-weighted mean of the triangles with all corners
/// kept; mean of the kept points when there are no such triangles. Unit and frame of the vertices.
Vec3d centroid(const Points3f& vertices, const Faces& faces, const BodyPoints& body);

}  // namespace vitruvian
