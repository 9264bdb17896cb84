#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Statistics of a set of distances, millimetres. `count` = 0 when nothing was measured.
struct DistanceStatistics {
  int count = 0;
  double mean_mm = 0, std_mm = 0, median_mm = 0, p95_mm = 0, max_mm = 0;
};

/// One row of the error table. `statistics` is empty where `observed` < 0.5 (contract.md).
struct SegmentError {
  std::string segment;
  double observed = 0;  ///< share of the segment's vertices with a compatible scan point within 20 mm
  std::optional<DistanceStatistics> statistics;
};

/// Both measures of contract.md and the scan's view of the model. `all` and `surface_all` pool the vertices
/// of the segments that have statistics: where nothing was scanned there is nothing to be near to.
struct SurfaceError {
  double observed = 0;  ///< share of all vertices with a compatible scan point within 20 mm
  std::vector<SegmentError>
      segments;  ///< 24: template vertex to matched scan point (paper, eq. 9's residual)
  DistanceStatistics all;
  std::vector<SegmentError>
      surface_segments;  ///< 24: template vertex to the closest point on the scan's triangles
  DistanceStatistics surface_all;
  DistanceStatistics scan_to_model;  ///< scan point to the closest point on the model's surface
};

}  // namespace vitruvian
