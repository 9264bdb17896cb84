#pragma once

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

  Points3f points;
  Points3f normals;
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

  /// Point nearest to a template vertex among those it may be matched with; index -1 when there is none.
  Neighbour nearest(int vertex, const Vec3f& position, const Vec3f& normal, bool normals_in_search) const;

 private:
  struct LabelTrees {
    KdTree by_position, by_position_and_normal;
  };
  std::vector<LabelTrees> of_label_;  // empty without regions
};

}  // namespace vitruvian
