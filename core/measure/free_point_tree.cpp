#include "measure/free_point_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vitruvian {
namespace {

constexpr std::int32_t kLeafSize = 32;

float squared_distance_to_box(const Vec3f& point, const Vec3f& low, const Vec3f& high) {
  const Vec3f outside = (low - point).cwiseMax(point - high).cwiseMax(0.0f);
  return outside.squaredNorm();
}

}  // namespace

struct FreePointTree::Search {
  Vec3f query;
  float half_width;
  float best_squared = std::numeric_limits<float>::infinity();
  std::int32_t best = -1;
};

FreePointTree::FreePointTree(const Points3f& points) {
  order_.resize(static_cast<std::size_t>(points.cols()));
  std::iota(order_.begin(), order_.end(), 0);
  points_.reserve(order_.size());
  for (Index i = 0; i < points.cols(); ++i) points_.push_back(points.col(i));
  leaf_.resize(order_.size());
  nodes_.reserve(4 * order_.size() / kLeafSize + 1);
  build(0, static_cast<std::int32_t>(order_.size()), -1);

  std::vector<Vec3f> by_leaf(points_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) by_leaf[k] = points_[order_[k]];
  points_ = std::move(by_leaf);
}

std::int32_t FreePointTree::build(std::int32_t begin, std::int32_t end, std::int32_t parent) {
  const auto self = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  Vec3f low = points_[order_[begin]], high = low;
  for (std::int32_t k = begin + 1; k < end; ++k) {
    low = low.cwiseMin(points_[order_[k]]);
    high = high.cwiseMax(points_[order_[k]]);
  }
  Node node{low, high, begin, end, end - begin, -1, -1, parent};
  if (end - begin <= kLeafSize) {
    for (std::int32_t k = begin; k < end; ++k) leaf_[order_[k]] = self;
  } else {
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const std::int32_t middle = begin + (end - begin) / 2;
    const auto before = [&](std::int32_t a, std::int32_t b) {
      const float u = points_[a][axis], v = points_[b][axis];
      return u < v || (u == v && a < b);
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, before);
    node.left = build(begin, middle, self);
    node.right = build(middle, end, self);
  }
  nodes_[self] = node;
  return self;
}

void FreePointTree::visit(std::int32_t index, Search& search) const {
  const Node& node = nodes_[index];
  if (node.left < 0) {
    for (std::int32_t k = node.begin; k < node.begin + node.free; ++k) {
      const Vec3f difference = points_[k] - search.query;
      if (difference.cwiseAbs().maxCoeff() > search.half_width) continue;
      const float squared = difference.squaredNorm();
      if (squared < search.best_squared || (squared == search.best_squared && order_[k] < search.best)) {
        search.best_squared = squared;
        search.best = order_[k];
      }
    }
    return;
  }
  std::pair<float, std::int32_t> children[2];
  int count = 0;
  for (const std::int32_t child : {node.left, node.right}) {
    const Node& candidate = nodes_[child];
    if (candidate.free == 0) continue;
    const Vec3f outside = (candidate.low - search.query).cwiseMax(search.query - candidate.high);
    if (outside.maxCoeff() > search.half_width) continue;
    children[count++] = {squared_distance_to_box(search.query, candidate.low, candidate.high), child};
  }
  if (count == 2 && children[1].first < children[0].first) std::swap(children[0], children[1]);
  for (int k = 0; k < count; ++k) {
    // Equal distances are searched too: the lowest index wins a tie.
    if (children[k].first <= search.best_squared) visit(children[k].second, search);
  }
}

int FreePointTree::nearest(const Vec3f& query, float half_width) const {
  if (nodes_.front().free == 0) return -1;
  Search search{query, half_width};
  visit(0, search);
  return search.best;
}

void FreePointTree::take(int index) {
  std::int32_t node = leaf_[index];
  const std::int32_t last = nodes_[node].begin + nodes_[node].free - 1;
  for (std::int32_t k = nodes_[node].begin; k <= last; ++k) {
    if (order_[k] != index) continue;
    std::swap(order_[k], order_[last]);
    std::swap(points_[k], points_[last]);
    break;
  }
  for (; node >= 0; node = nodes_[node].parent) --nodes_[node].free;
}

}  // namespace vitruvian
