#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/types.h"

namespace vitruvian {

struct Neighbour {
  int index = -1;
  float squared_distance = 0;
};

/// Exact nearest neighbours among 3-D points, or among 6-D points (position, normal * lambda) as used to keep
/// the two sides of a thin part apart. Copies what it is built from. Queries are const and may run in
/// parallel.
class KdTree {
 public:
  KdTree();
  /// 3-D tree. `subset` picks columns (empty: all); results are indices into `points` in either case.
  explicit KdTree(const Points3f& points, std::span<const int> subset = {});
  /// 6-D tree on (x, lambda n). `normals` has as many columns as `points`.
  KdTree(const Points3f& points, const Points3f& normals, float lambda, std::span<const int> subset = {});
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;
  ~KdTree();

  bool empty() const noexcept;
  int dimension() const noexcept;

  /// Nearest point; the tree must not be empty. In a 3-D tree the normal is ignored. Distance in the tree's
  /// metric.
  Neighbour nearest(const Vec3f& point, const Vec3f& normal = Vec3f::Zero()) const;
  /// The `count` nearest points of a 3-D tree (fewer if there are fewer), nearest first.
  void nearest(const Vec3f& point, int count, std::vector<Neighbour>& result) const;
  /// All points of a 3-D tree within `radius`, in unspecified but reproducible order.
  void within(const Vec3f& point, float radius, std::vector<Neighbour>& result) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace vitruvian
