#include "fit/scan_target.h"

#include <numeric>
#include <vector>

#include "base/random.h"

namespace vitruvian {

ScanTarget ScanTarget::sample(const Points3f& vertices, const Faces& faces, const Points3f& normals,
                              int count, std::uint32_t seed) {
  const SurfaceSamples samples = sample_surface(vertices, faces, normals, count, seed);
  Random random(seed + 1);
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), Index{0});
  for (int i = count - 1; i > 0; --i)
    std::swap(order[i], order[random.below(static_cast<std::uint32_t>(i + 1))]);
  Points3f points(3, count), directions(3, count);
  for (int i = 0; i < count; ++i) {
    points.col(i) = samples.points.col(order[i]);
    directions.col(i) = samples.normals.col(order[i]);
  }
  return from_points(std::move(points), std::move(directions));
}

ScanTarget ScanTarget::from_points(Points3f points, Points3f normals) {
  ScanTarget target;
  target.points = std::move(points);
  target.normals = std::move(normals);
  target.by_position = KdTree(target.points);
  target.by_position_and_normal = KdTree(target.points, target.normals, kNormalWeight);
  return target;
}

}  // namespace vitruvian
