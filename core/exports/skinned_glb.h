#pragma once

#include <string>

#include "exports/exported_body.h"

namespace vitruvian {

/// glTF 2.0 binary of the body with its skeleton: mesh at rest with shape and the pose's correctives applied,
/// skin with inverse bind matrices, joints in the registered pose, and an animation "pose" that holds it
/// (importers drop a bare pose). Metres, Y up, facing +Z. The skeleton's root node has
/// `extras.scan_from_glb`: 16 numbers, row by row, that take the posed mesh to the scan's frame and units.
std::string to_skinned_glb(const ExportedBody& body);

}  // namespace vitruvian
