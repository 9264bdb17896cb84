#pragma once

#include <vector>

#include "base/execution.h"
#include "fit/region_labels.h"
#include "geometry/kdtree.h"

namespace vitruvian {

struct ChamferOptions {
  bool one_directional = false;  ///< template to scan only
  int chunk = 0;                 ///< blockwise brute force with blocks of this size; 0: kd-trees
};

/// Chamfer distance between template vertices and scan points (paper, section 3.2, first two terms of the
/// objective; "Acceleration settings" for one direction only):
///   1/|V| sum_v min_u |v - u|  +  1/|S| sum_u min_v |u - v|,   distances not squared.
/// With regions, the sum of such distances over the labels, each with its own means (section 3.3.1: "we
/// compute the Chamfer loss separately for each selected region pair", and "an additional Chamfer loss
/// between the remaining" points).
class ChamferDistance {
 public:
  /// @param scan  3 x N, body frame, N > 0; copied.
  ChamferDistance(const Points3f& scan, const RegionLabels& regions, const ChamferOptions& options);

  /// Value at 3 x V vertices; `by_vertex` (resized) receives the derivative: unit vectors to the nearest
  /// points, zero where they coincide.
  double operator()(const Points3f& vertices, Points3f& by_vertex, const Execution& execution) const;

 private:
  struct Group {
    std::vector<int> scan_index, vertex_index;  ///< columns of the whole sets
    Points3f scan;
    KdTree scan_tree;  ///< over `scan`; empty when brute force is used
  };
  double add_group(const Group& group, const Points3f& vertices, Points3f& by_vertex,
                   const Execution& execution) const;

  ChamferOptions options_;
  std::vector<Group> groups_;
};

}  // namespace vitruvian
