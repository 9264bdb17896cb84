#pragma once

#include <vector>

namespace vitruvian {

/// Which scan points and template vertices may be matched with each other: only those of one label. Label 0:
/// everything that no region names.
struct RegionLabels {
  int count = 1;              ///< labels run from 0 to count - 1
  std::vector<int> scan;      ///< a label a scan point; empty: all 0
  std::vector<int> vertices;  ///< a label a template vertex; empty: all 0
};

}  // namespace vitruvian
