#pragma once

#include <vector>

#include "fit/surface_fit.h"

namespace vitruvian {

/// Feet and hands turned back to front leave all joints and most distances as they are; only the normals and
/// the shape of toes and fingers tell. For each whose surface fits worse than `misfit` (m, mean distance of
/// its samples in position and normal), the state with it turned half round the shank or forearm, and the
/// state with its joint straight. Empty for most fits.
std::vector<BodyState> turned_extremities(const FitModel& model, const ScanTarget& scan,
                                          const BodyState& state, double misfit);

/// Mean distance of a limb's hand or foot to the scan in position and normal, m. @param limb  as kLimbs.
double extremity_misfit(const FitModel& model, const ScanTarget& scan, const PosedModel& posed, int limb);

}  // namespace vitruvian
