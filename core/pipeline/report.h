#pragma once

#include <string>

#include "pipeline/registration.h"

namespace vitruvian {

/// errors.csv of contract.md: a row a segment of `surface_segments`, NA where a segment was not observed.
std::string errors_csv(const SurfaceError& error);

/// offsets.npz of contract.md: `offsets` [V, 3] float32, metres, rest pose, before skinning. Equal offsets
/// give equal bytes.
std::string offsets_npz(const Points3f& offsets);

/// A registration in plain words, some 40 lines: scan, alignment, verdict with reasons, errors by segment,
/// times.
std::string report_text(const Registration& registration);

}  // namespace vitruvian
