#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "pose/pose_vae.h"

namespace vitruvian {

/// Reads the networks of a VPoser v2 checkpoint (Pavlakos et al. 2019), as torch.save() writes it: a zip of a
/// pickle and raw tensors. Nothing of the pickle is executed. Batch normalisation is folded into the linear
/// layers, as it is fixed after training.
/// @throws Error(bad_model, bad_file, unsupported_format) naming the file, the tensor and what is wrong.
PoseVae read_vposer(std::span<const std::byte> bytes, const std::string& file_name);

}  // namespace vitruvian
