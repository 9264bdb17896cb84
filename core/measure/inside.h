#pragma once

#include "base/types.h"

namespace vitruvian {

/// Share, by area, of a closed surface that lies inside another part of itself, more than 5 mm deep: arms in
/// the trunk, legs in each other. Told by the signed crossings of a ray from each vertex, moved outward
/// first.
/// @param vertices, normals  3 x V, metres; normals unit, outward.
/// @param faces  3 x F, closed, counter-clockwise seen from outside.
double inside_share(const Points3f& vertices, const Points3f& normals, const Faces& faces);

}  // namespace vitruvian
