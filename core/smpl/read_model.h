#pragma once

#include "smpl/smpl_model.h"

namespace vitruvian {

/// Reads a body model of any kind: the default body's array file, or a file of the SMPL family.
/// @param options  of SMPL family files; the default body is read whole.
/// @throws what read_body_model() and read_smpl_model() throw.
BodyModel read_any_body_model(std::span<const std::byte> bytes, const std::string& file_name,
                              const SmplOptions& options = {});

/// True when the bytes begin like one of our own array files (models/README.md).
bool is_array_file(std::span<const std::byte> bytes) noexcept;

}  // namespace vitruvian
