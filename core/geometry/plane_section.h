#pragma once

#include <vector>

#include "base/types.h"
#include "geometry/convex_hull.h"

namespace vitruvian {

struct Plane {
  Vec3d point;
  Vec3d normal;  ///< unit
};

/// Where a section crosses a mesh edge: position = (1 - along) * vertex `from` + along * vertex `to`, so that
/// the curve can be carried to the same mesh in another pose.
struct SectionPoint {
  int from = 0, to = 0;
  double along = 0;
  Vec3d position = Vec3d::Zero();
};

/// One curve of a plane section. Seen from the side that the normal points to, the solid lies on the left:
/// outer curves run counter-clockwise.
struct SectionLoop {
  std::vector<SectionPoint> points;
  std::vector<int>
      face;            ///< the triangle between points i and i + 1 (the last: back to the first when closed)
  bool closed = true;  ///< open where the mesh has a hole
};

/// All curves in which a plane cuts a triangle mesh. A vertex on the plane counts as above it, so that there
/// are no special cases. Deterministic.
/// @param vertices  3 x V; @param faces  3 x F, indices below V.
std::vector<SectionLoop> plane_section(const Points3d& vertices, const Faces& faces, const Plane& plane);

/// What can be measured on one curve; an open one is closed by a straight line. Metres and square metres.
struct SectionMeasure {
  double area = 0;            ///< enclosed, positive
  double perimeter = 0;       ///< along the surface
  double hull_area = 0;       ///< of the convex hull
  double hull_perimeter = 0;  ///< of the convex hull: what a taut tape shows
  double breadth = 0;         ///< extent along the first direction
  double depth = 0;           ///< extent along the second
};

/// @param breadth_axis, depth_axis  perpendicular unit vectors in the plane.
SectionMeasure measure_section(const SectionLoop& loop, const Vec3d& breadth_axis, const Vec3d& depth_axis);

/// The curve's points in the plane's own coordinates along two perpendicular unit vectors.
Points2d project_section(const SectionLoop& loop, const Vec3d& first_axis, const Vec3d& second_axis);

/// Two unit vectors that with the normal form a right-handed orthonormal basis (first, second, normal).
/// @param hint  the first one is this, made perpendicular to the normal; anything when it is parallel to it.
std::pair<Vec3d, Vec3d> plane_axes(const Vec3d& normal, const Vec3d& hint);

}  // namespace vitruvian
