#pragma once

#include <cstdint>
#include <vector>

#include "base/execution.h"
#include "base/types.h"

namespace vitruvian {

/// Number of directions, spread evenly over the sphere in opposite pairs, from which a surface is looked at.
constexpr int kSkyDirections = 64;

/// 3 x 64 unit vectors from the surface to the sky; column k + 32 is the opposite of column k.
Points3f sky_directions();

/// Which directions of the sky each vertex sees past the rest of the surface: bit k for direction k. Found
/// from depth maps of about 1/256 of the surface's diameter a pixel, without normals, so winding does not
/// matter; a vertex that is seen only through the thickness of something thinner than about 1.5 pixels counts
/// as seen. A vertex with a non-finite coordinate sees nothing.
/// @param faces  empty for a bare cloud: points then hide what is behind as discs.
/// @param point_radii  V radii of those discs, in the unit of `vertices`; not used with faces.
std::vector<std::uint64_t> sky_visibility(const Points3f& vertices, const Faces& faces,
                                          const Eigen::VectorXf& point_radii, const Execution& execution);

/// Cosine-weighted share of the visible sky above each vertex, 0 (buried) .. 1 (open).
/// @param normals  unit, outward; where zero, all directions count the same.
Eigen::VectorXf ambient_occlusion(const std::vector<std::uint64_t>& visibility, const Points3f& normals);

/// Outward unit normals of a scan whose winding or normals cannot be trusted. Outward is where a vertex sees
/// the sky. If nine tenths of the clear cases agree on one orientation (inside-out or not), all faces keep
/// that one; if not, each face that is clear by itself is turned on its own and the rest follow the majority.
/// Vertices without a clue get zero.
/// @param normals  of a bare cloud, any sign, zero where unknown; not used with faces.
Points3f outward_normals(const Points3f& vertices, const Faces& faces, const Points3f& normals,
                         const std::vector<std::uint64_t>& visibility);

}  // namespace vitruvian
