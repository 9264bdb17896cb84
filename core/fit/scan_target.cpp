#include "fit/scan_target.h"

#include <numeric>
#include <vector>

#include "base/random.h"

namespace vitruvian {

namespace {

/// Label of a sample: that of the corner of its triangle that it is nearest to.
int label_of_sample(const SurfaceSamples& samples, Index sample, const Points3f& vertices, const Faces& faces,
                    const RegionLabels& labels) {
  const int source = samples.source[static_cast<std::size_t>(sample)];
  if (faces.cols() == 0) return labels.of_point(source);
  int nearest = 0;
  float least = 0;
  for (int k = 0; k < 3; ++k) {
    const float distance = (vertices.col(faces(k, source)) - samples.points.col(sample)).squaredNorm();
    if (k == 0 || distance < least) nearest = faces(k, source), least = distance;
  }
  return labels.of_point(nearest);
}

}  // namespace

ScanTarget ScanTarget::sample(const Points3f& vertices, const Faces& faces, const Points3f& normals,
                              int count, std::uint32_t seed, const RegionLabels& labels) {
  const SurfaceSamples samples = sample_surface(vertices, faces, normals, count, seed);
  Random random(seed + 1);
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), Index{0});
  for (int i = count - 1; i > 0; --i)
    std::swap(order[i], order[random.below(static_cast<std::uint32_t>(i + 1))]);
  Points3f points(3, count), directions(3, count);
  RegionLabels sample_labels{labels.count, {}, labels.vertices};
  for (int i = 0; i < count; ++i) {
    points.col(i) = samples.points.col(order[i]);
    directions.col(i) = samples.normals.col(order[i]);
    if (labels.count > 1)
      sample_labels.scan.push_back(label_of_sample(samples, order[i], vertices, faces, labels));
  }
  return from_points(std::move(points), std::move(directions), std::move(sample_labels));
}

void ScanTarget::mark_rim(const Points3f& rim, float radius) {
  at_rim.clear();
  if (rim.cols() == 0) return;
  const KdTree tree(rim);
  for (Index i = 0; i < points.cols(); ++i)
    at_rim.push_back(tree.nearest(points.col(i)).squared_distance < radius * radius);
}

ScanTarget ScanTarget::from_points(Points3f points, Points3f normals, RegionLabels labels) {
  ScanTarget target;
  target.points = std::move(points);
  target.normals = std::move(normals);
  target.regions = std::move(labels);
  target.by_position = KdTree(target.points);
  target.by_position_and_normal = KdTree(target.points, target.normals, kNormalWeight);
  if (target.regions.count == 1) return target;
  std::vector<std::vector<int>> members(static_cast<std::size_t>(target.regions.count));
  for (Index i = 0; i < target.points.cols(); ++i)
    members[static_cast<std::size_t>(target.regions.of_point(i))].push_back(static_cast<int>(i));
  target.of_label_.resize(members.size());
  for (std::size_t label = 0; label < members.size(); ++label) {
    // An empty subset would mean all points.
    if (members[label].empty()) continue;
    target.of_label_[label].by_position = KdTree(target.points, members[label]);
    target.of_label_[label].by_position_and_normal =
        KdTree(target.points, target.normals, kNormalWeight, members[label]);
  }
  return target;
}

Neighbour ScanTarget::nearest(int vertex, const Vec3f& position, const Vec3f& normal,
                              bool normals_in_search) const {
  if (of_label_.empty()) {
    return normals_in_search ? by_position_and_normal.nearest(position, normal)
                             : by_position.nearest(position);
  }
  const LabelTrees& trees = of_label_[static_cast<std::size_t>(regions.of_vertex(vertex))];
  const KdTree& tree = normals_in_search ? trees.by_position_and_normal : trees.by_position;
  return tree.empty() ? Neighbour() : tree.nearest(position, normal);
}

}  // namespace vitruvian
