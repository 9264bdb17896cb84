#include "geometry/kdtree.h"

#include <algorithm>
#include <nanoflann.hpp>

namespace vitruvian {
namespace {

constexpr int kLeafSize = 12;

/// Rows of `dimension` floats for nanoflann.
template <int dimension>
struct Cloud {
  std::vector<float> rows;
  std::size_t kdtree_get_point_count() const { return rows.size() / dimension; }
  float kdtree_get_pt(std::size_t i, std::size_t k) const { return rows[i * dimension + k]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

template <int dimension>
struct SearchTree {
  using Adaptor = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud<dimension>>,
                                                      Cloud<dimension>, dimension, std::uint32_t>;
  Cloud<dimension> cloud;
  std::unique_ptr<Adaptor> adaptor;

  void build() {
    adaptor =
        std::make_unique<Adaptor>(dimension, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
    adaptor->buildIndex();
  }
};

}  // namespace

struct KdTree::Tree {
  SearchTree<3> three;
  SearchTree<6> six;
  bool is_six = false;
  float lambda = 0;
  std::vector<int> original;  ///< row -> column of the points given; empty when they are the same

  int column(std::uint32_t row) const { return original.empty() ? static_cast<int>(row) : original[row]; }
};

KdTree::KdTree(const Points3f& points, std::span<const int> subset) : tree_(std::make_unique<Tree>()) {
  tree_->original.assign(subset.begin(), subset.end());
  const std::size_t count = subset.empty() ? points.cols() : subset.size();
  std::vector<float>& rows = tree_->three.cloud.rows;
  rows.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto point = points.col(tree_->column(i));
    std::copy_n(point.data(), 3, rows.data() + 3 * i);
  }
  if (count > 0) tree_->three.build();
}

KdTree::KdTree(const Points3f& points, const Points3f& normals, float lambda, std::span<const int> subset)
    : tree_(std::make_unique<Tree>()) {
  tree_->is_six = true;
  tree_->lambda = lambda;
  tree_->original.assign(subset.begin(), subset.end());
  const std::size_t count = subset.empty() ? points.cols() : subset.size();
  std::vector<float>& rows = tree_->six.cloud.rows;
  rows.resize(6 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const int column = tree_->column(i);
    for (int k = 0; k < 3; ++k) {
      rows[6 * i + k] = points(k, column);
      rows[6 * i + 3 + k] = lambda * normals(k, column);
    }
  }
  if (count > 0) tree_->six.build();
}

KdTree::KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;
KdTree::~KdTree() = default;

bool KdTree::empty() const noexcept { return !tree_ || (!tree_->three.adaptor && !tree_->six.adaptor); }

int KdTree::dimension() const noexcept { return tree_ && tree_->is_six ? 6 : 3; }

Neighbour KdTree::nearest(const Vec3f& point, const Vec3f& normal) const {
  std::uint32_t row = 0;
  float squared_distance = 0;
  nanoflann::KNNResultSet<float, std::uint32_t> result(1);
  result.init(&row, &squared_distance);
  if (tree_->is_six) {
    const float query[6] = {point[0],
                            point[1],
                            point[2],
                            tree_->lambda * normal[0],
                            tree_->lambda * normal[1],
                            tree_->lambda * normal[2]};
    tree_->six.adaptor->findNeighbors(result, query, {});
  } else {
    tree_->three.adaptor->findNeighbors(result, point.data(), {});
  }
  return {tree_->column(row), squared_distance};
}

void KdTree::nearest(const Vec3f& point, int count, std::vector<Neighbour>& result) const {
  result.clear();
  if (empty() || count <= 0) return;
  const std::size_t wanted = std::min<std::size_t>(count, tree_->three.cloud.kdtree_get_point_count());
  std::vector<std::uint32_t> rows(wanted);
  std::vector<float> distances(wanted);
  nanoflann::KNNResultSet<float, std::uint32_t> found(wanted);
  found.init(rows.data(), distances.data());
  tree_->three.adaptor->findNeighbors(found, point.data(), {});
  result.reserve(wanted);
  for (std::size_t i = 0; i < found.size(); ++i) result.push_back({tree_->column(rows[i]), distances[i]});
}

void KdTree::within(const Vec3f& point, float radius, std::vector<Neighbour>& result) const {
  result.clear();
  if (empty()) return;
  std::vector<std::pair<std::uint32_t, float>> found;
  nanoflann::RadiusResultSet<float, std::uint32_t> set(radius * radius, found);
  tree_->three.adaptor->findNeighbors(set, point.data(), {});
  result.reserve(found.size());
  for (const auto& [row, squared_distance] : found) result.push_back({tree_->column(row), squared_distance});
}

}  // namespace vitruvian
