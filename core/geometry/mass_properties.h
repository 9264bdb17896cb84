#pragma once

#include "base/types.h"

namespace vitruvian {

/// What a solid of density 1 bounded by a closed mesh weighs and how it turns.
struct MassProperties {
  double volume = 0;  ///< m^3, signed: positive when faces are counter-clockwise seen from outside
  Vec3d centroid = Vec3d::Zero();  ///< the mesh's frame; the vertices' mean when there is no volume
  Mat3d inertia =
      Mat3d::Zero();  ///< m^5, about the centroid, axes of the mesh's frame; times density: kg m^2
};

/// Exact integrals over the polyhedron (sum of signed tetrahedra).
MassProperties mass_properties(const Points3d& vertices, const Faces& faces);

/// Area of a triangle mesh.
double surface_area(const Points3d& vertices, const Faces& faces);

}  // namespace vitruvian
