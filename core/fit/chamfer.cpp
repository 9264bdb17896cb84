#include "fit/chamfer.h"

#include <cmath>

#include "base/error.h"
#include "geometry/nearest_blockwise.h"

namespace vitruvian {
namespace {

Points3f columns_of(const Points3f& points, const std::vector<int>& index) {
  Points3f result(3, static_cast<Index>(index.size()));
  for (Index i = 0; i < result.cols(); ++i) result.col(i) = points.col(index[static_cast<std::size_t>(i)]);
  return result;
}

std::vector<Neighbour> nearest_in(const Points3f& from, const Points3f& to, const KdTree& tree, int chunk,
                                  const Execution& execution) {
  if (chunk > 0) return nearest_blockwise(from, to, chunk, execution);
  std::vector<Neighbour> result(static_cast<std::size_t>(from.cols()));
  execution.parallel_for(from.cols(), 512, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      result[static_cast<std::size_t>(i)] = tree.nearest(Vec3f(from.col(i)));
  });
  return result;
}

}  // namespace

ChamferDistance::ChamferDistance(const Points3f& scan, const RegionLabels& regions,
                                 const ChamferOptions& options)
    : options_(options), groups_(static_cast<std::size_t>(regions.count)) {
  if (scan.cols() == 0) throw Error(ErrorCode::internal, "Chamfer distance: no scan point");
  for (Index i = 0; i < scan.cols(); ++i) {
    const int label = regions.scan.empty() ? 0 : regions.scan.at(static_cast<std::size_t>(i));
    groups_.at(static_cast<std::size_t>(label)).scan_index.push_back(static_cast<int>(i));
  }
  for (std::size_t v = 0; v < regions.vertices.size(); ++v)
    groups_.at(static_cast<std::size_t>(regions.vertices[v])).vertex_index.push_back(static_cast<int>(v));
  const bool one = regions.count == 1;
  for (Group& group : groups_) {
    group.scan = one ? scan : columns_of(scan, group.scan_index);
    if (options.chunk == 0) group.scan_tree = KdTree(group.scan);
  }
  if (one) groups_.front().vertex_index.clear();
}

double ChamferDistance::operator()(const Points3f& vertices, Points3f& by_vertex,
                                   const Execution& execution) const {
  by_vertex.setZero(3, vertices.cols());
  if (groups_.size() == 1) return add_group(groups_.front(), vertices, by_vertex, execution);
  double value = 0;
  for (const Group& group : groups_) {
    if (group.vertex_index.empty() || group.scan_index.empty()) continue;
    Points3f part_by_vertex = Points3f::Zero(3, static_cast<Index>(group.vertex_index.size()));
    value += add_group(group, columns_of(vertices, group.vertex_index), part_by_vertex, execution);
    for (std::size_t i = 0; i < group.vertex_index.size(); ++i)
      by_vertex.col(group.vertex_index[i]) = part_by_vertex.col(static_cast<Index>(i));
  }
  return value;
}

double ChamferDistance::add_group(const Group& group, const Points3f& vertices, Points3f& by_vertex,
                                  const Execution& execution) const {
  double to_scan = 0, to_template = 0;
  const auto vertex_count = static_cast<double>(vertices.cols());
  const std::vector<Neighbour> nearest_point =
      nearest_in(vertices, group.scan, group.scan_tree, options_.chunk, execution);
  for (Index v = 0; v < vertices.cols(); ++v) {
    const Neighbour& found = nearest_point[static_cast<std::size_t>(v)];
    const double distance = std::sqrt(static_cast<double>(found.squared_distance));
    to_scan += distance;
    if (distance > 0) {
      by_vertex.col(v) +=
          (vertices.col(v) - group.scan.col(found.index)) / static_cast<float>(distance * vertex_count);
    }
  }
  if (options_.one_directional) return to_scan / vertex_count;

  const auto point_count = static_cast<double>(group.scan.cols());
  const KdTree tree = options_.chunk > 0 ? KdTree() : KdTree(vertices);
  const std::vector<Neighbour> nearest_vertex =
      nearest_in(group.scan, vertices, tree, options_.chunk, execution);
  for (Index i = 0; i < group.scan.cols(); ++i) {
    const Neighbour& found = nearest_vertex[static_cast<std::size_t>(i)];
    const double distance = std::sqrt(static_cast<double>(found.squared_distance));
    to_template += distance;
    if (distance > 0) {
      by_vertex.col(found.index) +=
          (vertices.col(found.index) - group.scan.col(i)) / static_cast<float>(distance * point_count);
    }
  }
  return to_scan / vertex_count + to_template / point_count;
}

}  // namespace vitruvian
