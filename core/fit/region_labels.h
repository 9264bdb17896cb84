#pragma once

#include <cstddef>
#include <vector>

namespace vitruvian {

/// Which scan points and template vertices may be matched with each other: only those of one label. Label 0:
/// everything that no region names.
struct RegionLabels {
  int count = 1;              ///< labels run from 0 to count - 1
  std::vector<int> scan;      ///< a label a scan point; empty: all 0
  std::vector<int> vertices;  ///< a label a template vertex; empty: all 0

  int of_point(std::ptrdiff_t i) const { return scan.empty() ? 0 : scan[static_cast<std::size_t>(i)]; }
  int of_vertex(std::ptrdiff_t v) const {
    return vertices.empty() ? 0 : vertices[static_cast<std::size_t>(v)];
  }
};

}  // namespace vitruvian
