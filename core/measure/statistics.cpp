#include "measure/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vitruvian {

double quantile_of_sorted(std::span<const float> sorted, double fraction) {
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double low = sorted[below], high = sorted[above];
  return low + (high - low) * (place - static_cast<double>(below));
}

DistanceStatistics distance_statistics(std::vector<float> distances_m) {
  DistanceStatistics result;
  if (distances_m.empty()) return result;
  std::sort(distances_m.begin(), distances_m.end());
  double sum = 0;
  for (const float d : distances_m) sum += d;
  const double mean = sum / static_cast<double>(distances_m.size());
  double squares = 0;
  for (const float d : distances_m) squares += (d - mean) * (d - mean);
  result.count = static_cast<int>(distances_m.size());
  result.mean_mm = 1e3 * mean;
  result.std_mm = 1e3 * std::sqrt(squares / static_cast<double>(distances_m.size()));
  result.median_mm = 1e3 * quantile_of_sorted(distances_m, 0.5);
  result.p95_mm = 1e3 * quantile_of_sorted(distances_m, 0.95);
  result.max_mm = 1e3 * distances_m.back();
  return result;
}

}  // namespace vitruvian
