#pragma once

#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Least cosine between a triangle's normal and the one that it had before: one that turned further counts as
/// folded.
constexpr double kLeastFacing = 0.0;

/// Triangles that a displacement turned over: cosine of the normals before and after below `least_facing`.
std::vector<int> folded_faces(const Points3d& vertices, const Points3d& displacement, const Faces& faces,
                              double least_facing = kLeastFacing);

/// Smooths the displacement round folded triangles, and where that does not help takes it back to nothing,
/// until no triangle is folded. Vertices away from folds keep theirs.
/// @param vertices  3 x V, before.
void unfold(const Points3d& vertices, const Faces& faces, Points3d& displacement);

}  // namespace vitruvian
