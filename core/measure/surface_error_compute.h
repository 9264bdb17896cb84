#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/execution.h"
#include "base/types.h"
#include "geometry/closest_point.h"
#include "geometry/kdtree.h"
#include "geometry/scan_surface.h"
#include "measure/surface_error.h"

namespace vitruvian {

/// The registered template, body frame, metres. Refers to the caller's arrays.
struct PosedTemplate {
  const Points3f& vertices;               ///< 3 x V
  const Points3f& normals;                ///< 3 x V, unit, outward
  const Faces& faces;                     ///< 3 x F
  std::span<const std::uint8_t> segment;  ///< V, 0..23
};

/// A scan point counts as a template vertex's own when it lies this near and its normal turns less than this
/// away.
constexpr float kObservedDistance = 0.020f;
constexpr float kCompatibleCosine = 0.2f;
/// Below this share of observed vertices a segment has no statistics (contract.md).
constexpr double kObservedShare = 0.5;

/// SurfaceError and what it was computed from, for colouring the mesh and for the verdict.
struct SurfaceMeasurement {
  SurfaceError error;
  std::vector<int> matched_point;         ///< V: scan point matched to each vertex (paper's rematching)
  std::vector<float> point_distance_m;    ///< V: to that point
  std::vector<float> surface_distance_m;  ///< V: to the scan's surface
  std::vector<std::uint8_t> observed;     ///< V: 1 where a compatible scan point lies within 20 mm
  std::vector<int> sampled_point;         ///< scan points used for scan_to_model
  std::vector<float> sampled_distance_m;  ///< their distance to the model's surface
  std::vector<int> sampled_vertex;        ///< template vertex nearest to where they meet the model's surface
  /// Share, by area, of the model's surface within 20 mm of the scan's that faces against it (cosine < 0).
  double opposed_share = 0;
  std::vector<double> segment_opposed_share;  ///< 24: the same of each segment
};

/// Measures a registration in both directions. At most 50,000 scan points, spread evenly over the file's
/// order, stand for the scan in scan_to_model.
/// @throws Error(internal) when sizes contradict each other or the scan is empty; Error(cancelled).
SurfaceMeasurement measure_surface(const PosedTemplate& model, const ScanSurface& scan,
                                   const Execution& execution);

/// Distance from `point` to the local plane of a bare cloud: the plane of the 12 cloud points nearest to the
/// nearest one, bounded by their extent, so that a point beyond the cloud's edge is not measured against an
/// endless plane.
float distance_to_cloud(const Vec3f& point, const Points3f& cloud, const KdTree& tree);

}  // namespace vitruvian
