#include "paint/parts.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "geometry/kdtree.h"

namespace vitruvian {

std::vector<std::uint8_t> scan_segments(const Points3f& scan, const Points3f& body,
                                        std::span<const std::uint8_t> segment, float reach_m) {
  const KdTree tree(body);
  std::vector<std::uint8_t> found(static_cast<std::size_t>(scan.cols()), kNoSegment);
  for (Index i = 0; i < scan.cols(); ++i) {
    const Vec3f p = scan.col(i);
    if (!p.allFinite()) continue;
    const Neighbour nearest = tree.nearest(p);
    if (nearest.squared_distance <= reach_m * reach_m) {
      found[static_cast<std::size_t>(i)] = segment[static_cast<std::size_t>(nearest.index)];
    }
  }
  return found;
}

std::vector<int> flood(const Faces& faces, std::span<const std::uint8_t> label, int start) {
  if (start < 0 || static_cast<std::size_t>(start) >= label.size()) {
    throw Error(ErrorCode::usage, "painting: there is no vertex " + std::to_string(start));
  }
  // Sets of connected vertices: each vertex points to one nearer to its set's first.
  std::vector<int> towards(label.size());
  for (std::size_t i = 0; i < towards.size(); ++i) towards[i] = static_cast<int>(i);
  const auto first_of = [&](int i) {
    while (towards[static_cast<std::size_t>(i)] != i) {
      int& next = towards[static_cast<std::size_t>(i)];
      next = towards[static_cast<std::size_t>(next)];
      i = next;
    }
    return i;
  };
  const std::uint8_t wanted = label[static_cast<std::size_t>(start)];
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = faces(corner, f), b = faces((corner + 1) % 3, f);
      if (label[static_cast<std::size_t>(a)] != wanted || label[static_cast<std::size_t>(b)] != wanted)
        continue;
      const int i = first_of(a), j = first_of(b);
      towards[static_cast<std::size_t>(std::max(i, j))] = std::min(i, j);
    }
  }
  std::vector<int> reached;
  for (int i = 0; i < static_cast<int>(label.size()); ++i) {
    if (label[static_cast<std::size_t>(i)] == wanted && first_of(i) == first_of(start)) reached.push_back(i);
  }
  return reached;
}

}  // namespace vitruvian
