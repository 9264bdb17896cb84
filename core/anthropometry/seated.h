#pragma once

#include <vector>

#include "anthropometry/dimensions.h"

namespace vitruvian {

/// Dimensions of ISO 7250-1 that are taken sitting.
/// @param seated  the body in seated_posture(). The seat is at the lowest point of buttocks and thighs: no
/// chair presses the flesh, so heights above the seat come out a little large.
std::vector<Dimension> measure_seated(const Figure& seated, const LandmarkSet& landmarks,
                                      const FitQuality& fit);

}  // namespace vitruvian
