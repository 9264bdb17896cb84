#pragma once

#include <cstdint>
#include <vector>

#include "base/execution.h"
#include "fit/region_labels.h"
#include "geometry/closest_point.h"
#include "geometry/kdtree.h"
#include "geometry/mesh.h"

namespace vitruvian {

/// The scan as the fit sees it: body frame, metres, points spread evenly over the surface in random order, so
/// that any prefix is an even, coarser sampling.
struct ScanTarget {
  /// Metres that a turned normal counts in the six-dimensional neighbour search.
  static constexpr float kNormalWeight = 0.05f;

  /// A body's point this far or farther from the nearest sample, which lies at a rim, was not scanned.
  static constexpr float kUnseenDistance = 0.02f;

  Points3f points;
  Points3f normals;
  /// Whether each sample lies at the rim of a hole or of the whole scan; empty: there is none.
  std::vector<std::uint8_t> at_rim;
  KdTree by_position;
  KdTree by_position_and_normal;
  RegionLabels regions;  ///< `scan`: a label a point of this target

  /// @param vertices, faces, normals  the scan, body frame, metres; without faces the vertices are the
  /// samples.
  /// @param count  number of points wanted.
  /// @param labels  which of the scan's vertices may be matched with which of the template's.
  static ScanTarget sample(const Points3f& vertices, const Faces& faces, const Points3f& normals, int count,
                           std::uint32_t seed, const RegionLabels& labels = {});
  static ScanTarget from_points(Points3f points, Points3f normals, RegionLabels labels = {});

  /// Marks the samples within `radius` (m) of points on the rim of the scan.
  void mark_rim(const Points3f& rim, float radius);

  /// Point nearest to a template vertex among those it may be matched with; index -1 when there is none.
  Neighbour nearest(int vertex, const Vec3f& position, const Vec3f& normal, bool normals_in_search) const;

  /// Whether a body's point whose nearest sample is `index`, at `squared_distance`, lies over a hole.
  bool unseen(int index, float squared_distance) const {
    return !at_rim.empty() && at_rim[index] != 0 && squared_distance > kUnseenDistance * kUnseenDistance;
  }

 private:
  struct LabelTrees {
    KdTree by_position, by_position_and_normal;
  };
  std::vector<LabelTrees> of_label_;  // empty without regions
};

}  // namespace vitruvian
