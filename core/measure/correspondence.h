#pragma once

#include <vector>

#include "base/execution.h"
#include "base/types.h"
#include "geometry/kdtree.h"

namespace vitruvian {

/// The two ways of matching template vertices to scan points (paper, "Correspondence Rematching").
enum class Rematching {
  sparse,  ///< nearest scan point of each vertex; points may be shared
  dense,   ///< one to one
};

/// Scans with more points than this are matched one to one.
constexpr Index kDenseRematchingThreshold = 30000;

/// The paper's choice by the number of scan points; `sparse` also when there are too few points for one each.
Rematching choose_rematching(Index template_vertices, Index scan_points);

/// Nearest scan point of each template vertex. @return V indices into the points that `scan_tree` holds.
std::vector<int> match_sparse(const Points3f& template_vertices, const KdTree& scan_tree,
                              const Execution& execution);

/// The paper's injective matching: template vertices in their order each take the nearest scan point still
/// free inside a box of half-width h/50 about the vertex (h: height of the posed template), grown by 1.5 up
/// to four times, then the nearest free one anywhere. Of equally near points the lowest index is taken.
/// @param template_vertices  3 x V, body frame (Y up).
/// @param scan_points        3 x N, body frame, N >= V.
std::vector<int> match_dense(const Points3f& template_vertices, const Points3f& scan_points,
                             const Execution& execution);

/// match_dense or match_sparse, as choose_rematching() says.
std::vector<int> rematch(const Points3f& template_vertices, const Points3f& scan_points,
                         const KdTree& scan_tree, const Execution& execution);

}  // namespace vitruvian
