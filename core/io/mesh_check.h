#pragma once

#include "io/mesh_writer.h"

namespace vitruvian {

/// Throws Error(internal) when sizes or indices contradict each other or a number is not finite.
void check_mesh(const MeshView& mesh);

}  // namespace vitruvian
