#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// A kd-tree of points that can be taken out one by one, for greedy one-to-one matching: a search never sees
/// points already taken, however many of them surround the query. Ties in distance go to the lowest index.
class FreePointTree {
 public:
  /// @param points  3 x N, finite, N > 0; copied.
  explicit FreePointTree(const Points3f& points);

  /// Index of the nearest point not yet taken (Euclidean distance) among those whose coordinates all differ
  /// from the query's by at most `half_width`; -1 when there is none.
  int nearest(const Vec3f& query, float half_width = std::numeric_limits<float>::infinity()) const;

  /// Takes a point out. It must be free.
  void take(int index);

  int free_count() const { return nodes_.front().free; }

 private:
  struct Node {
    Vec3f low, high;     ///< bounding box of the node's points
    std::int32_t begin;  ///< its points are order_[begin, end)
    std::int32_t end;
    std::int32_t free =
        0;  ///< number of its points not yet taken; free ones of a leaf stand first in its range
    std::int32_t left = -1;  ///< child nodes, -1 in a leaf
    std::int32_t right = -1;
    std::int32_t parent = -1;
  };
  struct Search;

  std::int32_t build(std::int32_t begin, std::int32_t end, std::int32_t parent);
  void visit(std::int32_t node, Search& search) const;

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;  ///< point indices in leaf order
  std::vector<Vec3f> points_;        ///< in leaf order
  std::vector<std::int32_t> leaf_;   ///< leaf node of each point, by point index
};

}  // namespace vitruvian
