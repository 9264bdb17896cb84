#include <Eigen/Eigenvalues>
#include <algorithm>
#include <queue>
#include <vector>

#include "geometry/kdtree.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

struct Edge {
  float cost;
  int from, to;
  bool operator<(const Edge& other) const { return cost > other.cost; }
};

}  // namespace

Points3f point_cloud_normals(const Points3f& points, int neighbours, const Execution& execution) {
  const Index count = points.cols();
  Points3f normals = Points3f::Zero(3, count);
  if (count == 0) return normals;
  const KdTree tree(points);
  std::vector<int> graph(static_cast<std::size_t>(count) * neighbours, -1);
  execution.parallel_for(count, 1000, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<Neighbour> found;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      tree.nearest(points.col(i), neighbours, found);
      Vec3f mean = Vec3f::Zero();
      for (const Neighbour& n : found) mean += points.col(n.index);
      mean /= static_cast<float>(found.size());
      Mat3f covariance = Mat3f::Zero();
      for (std::size_t k = 0; k < found.size(); ++k) {
        const Vec3f d = points.col(found[k].index) - mean;
        covariance += d * d.transpose();
        graph[static_cast<std::size_t>(i) * neighbours + k] = found[k].index;
      }
      Eigen::SelfAdjointEigenSolver<Mat3f> solver;
      solver.computeDirect(covariance);
      normals.col(i) = solver.eigenvectors().col(0);
    }
  });
  // Orientation: start at the point farthest from the centre, whose outward side is known, and walk over the
  // neighbour graph along the edges where normals agree best (Hoppe et al. 1992).
  const Vec3f centre = points.rowwise().mean();
  std::vector<Index> by_distance(count);
  for (Index i = 0; i < count; ++i) by_distance[i] = i;
  std::sort(by_distance.begin(), by_distance.end(), [&](Index a, Index b) {
    const float da = (points.col(a) - centre).squaredNorm(), db = (points.col(b) - centre).squaredNorm();
    return da != db ? da > db : a < b;
  });
  std::vector<std::uint8_t> visited(count, 0);
  std::priority_queue<Edge> queue;
  for (const Index seed : by_distance) {
    if (visited[seed]) continue;
    if (normals.col(seed).dot(points.col(seed) - centre) < 0) normals.col(seed) *= -1;
    visited[seed] = 1;
    const auto push = [&](int from) {
      for (int k = 0; k < neighbours; ++k) {
        const int to = graph[static_cast<std::size_t>(from) * neighbours + k];
        if (to < 0 || visited[to]) continue;
        queue.push({1 - std::abs(normals.col(from).dot(normals.col(to))), from, to});
      }
    };
    push(static_cast<int>(seed));
    while (!queue.empty()) {
      const Edge edge = queue.top();
      queue.pop();
      if (visited[edge.to]) continue;
      visited[edge.to] = 1;
      if (normals.col(edge.from).dot(normals.col(edge.to)) < 0) normals.col(edge.to) *= -1;
      push(edge.to);
    }
  }
  return normals;
}

}  // namespace vitruvian
