#include "geometry/nearest_blockwise.h"

#include <algorithm>
#include <limits>

namespace vitruvian {

std::vector<Neighbour> nearest_blockwise(const Points3f& from, const Points3f& to, int chunk,
                                         const Execution& execution) {
  using Row = Eigen::Array<float, 1, Eigen::Dynamic>;
  const Row x = to.row(0), y = to.row(1), z = to.row(2);
  std::vector<Neighbour> result(static_cast<std::size_t>(from.cols()),
                                Neighbour{-1, std::numeric_limits<float>::infinity()});
  execution.parallel_for(from.cols(), chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    // A block of distances: a row for each of the `from` points.
    Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> block;
    for (std::ptrdiff_t first = begin; first < end; first += chunk) {
      const Index rows = std::min<Index>(chunk, end - first);
      for (Index other = 0; other < to.cols(); other += chunk) {
        execution.check();
        const Index columns = std::min<Index>(chunk, to.cols() - other);
        block.resize(rows, columns);
        for (Index i = 0; i < rows; ++i) {
          const Vec3f p = from.col(first + i);
          block.row(i) = (x.segment(other, columns) - p.x()).square() +
                         (y.segment(other, columns) - p.y()).square() +
                         (z.segment(other, columns) - p.z()).square();
        }
        for (Index i = 0; i < rows; ++i) {
          Index column = 0;
          const float squared = block.row(i).minCoeff(&column);
          Neighbour& best = result[static_cast<std::size_t>(first + i)];
          if (squared < best.squared_distance) best = {static_cast<int>(other + column), squared};
        }
      }
    }
  });
  return result;
}

}  // namespace vitruvian
