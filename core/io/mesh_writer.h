#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/types.h"

namespace vitruvian {

/// What to write: a triangle mesh with optional values of its vertices. Refers to the caller's data.
struct MeshView {
  const Points3d& vertices;                    ///< 3 x V, scan frame, scan units; finite
  const Faces& faces;                          ///< 3 x F, indices below V
  std::span<const std::uint8_t> colours = {};  ///< 3V, RGB; or empty
  std::span<const float> values = {};          ///< V, one more property; or empty
  std::string value_name = "value";            ///< lower-case letters, digits and _
};

// The writers give the whole file. All throw Error(internal) when sizes or indices contradict each other, or
// a number is not finite.

/// Binary little-endian PLY. Coordinates are float32 where that rounds by less than a millionth of the mesh's
/// extent, else float64 (scans far from their origin).
std::string to_ply(const MeshView& mesh);

/// OBJ with as many digits as the coordinates carry; colours behind the coordinates; no extra property.
std::string to_obj(const MeshView& mesh);

/// glTF 2.0 binary that opens upright in metres: positions are float32 around the mesh's own centre, and the
/// root node's matrix carries them into the body frame, which has glTF's axes (Y up, facing +Z). The root
/// node's `extras` hold `scan_from_glb`: 16 numbers, four rows of four, inverse of `body_from_scan`. Colours
/// become COLOR_0, the extra property the attribute `_` + its name in capitals.
/// @param body_from_scan  unit factor included; invertible.
std::string to_glb(const MeshView& mesh, const Mat4d& body_from_scan);

}  // namespace vitruvian
