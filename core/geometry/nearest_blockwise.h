#pragma once

#include <vector>

#include "base/execution.h"
#include "geometry/kdtree.h"

namespace vitruvian {

/// Nearest of the `to` points for each of the `from` points by brute force, one block of at most chunk x
/// chunk distances at a time (paper, "Memory-efficient Chamfer evaluation"): O(M N) comparisons, O(chunk^2)
/// memory a thread. Distances are computed as a KdTree computes them, so both give the same numbers; of
/// equally near points the lowest index is taken.
/// @param from, to  3 x M, 3 x N, N > 0.  @param chunk  at least 1.  @return M.
std::vector<Neighbour> nearest_blockwise(const Points3f& from, const Points3f& to, int chunk,
                                         const Execution& execution);

}  // namespace vitruvian
