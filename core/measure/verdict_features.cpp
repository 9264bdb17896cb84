#include "measure/verdict_features.h"

#include <algorithm>
#include <utility>

#include "measure/statistics.h"

namespace vitruvian {
namespace {

constexpr float kUnexplainedDistance = 0.050f;

/// How the scan's points lie off the body, by the segment nearest to each.
void add_points_of_parts(const SurfaceMeasurement& measurement, std::span<const std::uint8_t> segment,
                         VerdictFeatures& f) {
  std::array<std::vector<float>, 24> distances;
  std::array<int, 24> far{};
  for (std::size_t k = 0; k < measurement.sampled_vertex.size(); ++k) {
    const std::size_t s = segment[static_cast<std::size_t>(measurement.sampled_vertex[k])];
    distances[s].push_back(measurement.sampled_distance_m[k]);
    far[s] += measurement.sampled_distance_m[k] > kUnexplainedDistance ? 1 : 0;
  }
  for (std::size_t s = 0; s < distances.size(); ++s) {
    if (distances[s].empty()) continue;
    f.part_unexplained_share[s] = static_cast<double>(far[s]) / static_cast<double>(distances[s].size());
    f.part_scan_to_model_p95_mm[s] = distance_statistics(std::move(distances[s])).p95_mm;
  }
}

}  // namespace

VerdictFeatures features_from(const SurfaceMeasurement& measurement, std::span<const std::uint8_t> segment) {
  VerdictFeatures f;
  const SurfaceError& error = measurement.error;
  f.model_to_scan_p95_mm = error.surface_all.p95_mm;
  f.model_to_scan_mean_mm = error.surface_all.mean_mm;
  f.scan_to_model_p95_mm = error.scan_to_model.p95_mm;
  f.scan_to_model_mean_mm = error.scan_to_model.mean_mm;
  f.opposed_share = measurement.opposed_share;
  const std::vector<float>& distances = measurement.sampled_distance_m;
  if (!distances.empty()) {
    const auto far =
        std::count_if(distances.begin(), distances.end(), [](float d) { return d > kUnexplainedDistance; });
    f.unexplained_share = static_cast<double>(far) / static_cast<double>(distances.size());
  }
  for (std::size_t s = 0; s < error.surface_segments.size() && s < f.observed_share.size(); ++s) {
    f.observed_share[s] = error.surface_segments[s].observed;
    if (const auto& own = error.surface_segments[s].statistics) f.part_model_to_scan_p95_mm[s] = own->p95_mm;
  }
  std::copy_n(measurement.segment_opposed_share.begin(),
              std::min(measurement.segment_opposed_share.size(), f.part_opposed_share.size()),
              f.part_opposed_share.begin());
  add_points_of_parts(measurement, segment, f);
  return f;
}

void leave_out_unseen(std::span<const std::uint8_t> unseen, std::span<const std::uint8_t> segment,
                      const SurfaceMeasurement& measurement, VerdictFeatures& features) {
  std::array<int, 24> count{}, hidden{};
  for (std::size_t v = 0; v < unseen.size(); ++v) {
    ++count[segment[v]];
    hidden[segment[v]] += unseen[v] != 0 ? 1 : 0;
  }
  if (std::all_of(hidden.begin(), hidden.end(), [](int n) { return n == 0; })) return;
  std::vector<float> distances;
  std::array<std::vector<float>, 24> of_part;
  for (std::size_t s = 0; s < count.size(); ++s)
    features.unseen_share[s] = count[s] > 0 ? static_cast<double>(hidden[s]) / count[s] : 0;
  for (std::size_t v = 0; v < unseen.size(); ++v) {
    const std::size_t s = segment[v];
    const double shown = 1 - features.unseen_share[s];
    if (unseen[v] == 0 && features.observed_share[s] >= kObservedShare * shown) {
      distances.push_back(measurement.surface_distance_m[v]);
      of_part[s].push_back(measurement.surface_distance_m[v]);
    }
  }
  for (std::size_t s = 0; s < of_part.size(); ++s)
    features.part_model_to_scan_p95_mm[s] = distance_statistics(std::move(of_part[s])).p95_mm;
  const DistanceStatistics statistics = distance_statistics(std::move(distances));
  features.model_to_scan_p95_mm = statistics.p95_mm;
  features.model_to_scan_mean_mm = statistics.mean_mm;
}

}  // namespace vitruvian
