#pragma once

#include <span>
#include <vector>

#include "measure/surface_error.h"

namespace vitruvian {

/// Statistics of distances given in metres, returned in millimetres. `std_mm` is the population's (divides by
/// the count), median and p95 interpolate linearly between order statistics. An empty set gives all zeros.
DistanceStatistics distance_statistics(std::vector<float> distances_m);

/// Value below which the share `fraction` (0..1) of the ascending, non-empty `sorted` lies, linearly
/// interpolated.
double quantile_of_sorted(std::span<const float> sorted, double fraction);

}  // namespace vitruvian
