#pragma once

#include <vector>

#include "base/execution.h"
#include "geometry/mesh.h"
#include "geometry/scan_surface.h"

namespace vitruvian {

/// How far and how certainly the scan draws at the model, both ways.
struct PullSettings {
  double reach;         ///< m; points farther apart do not know of each other
  double robust_scale;  ///< m; of the Geman-McClure weights
  double foot_share;    ///< weight of a vertex's own closest scan point beside the scan samples round it
  int stride = 1;       ///< only every stride-th sample draws
};

/// Where the scan wants each vertex to go.
struct Pull {
  Points3d displacement;   ///< 3 x V, m, from the vertex's present place; 0 where the weight is 0
  Eigen::VectorXd weight;  ///< V, 0 (not observed) .. 1 + foot_share
  /// Median over the vertices of the spread (standard deviation) of the scan samples round a vertex along the
  /// normal, m: noise, and what the model's triangles are too coarse for.
  double roughness = 0;
};

/// Samples of the part of a scan that lies within about `reach` of some point of `body`: a floor or a wall
/// would take most of them otherwise. None when nothing lies there.
/// @param body  3 x V, points dense for the reach.
SurfaceSamples sample_near(const ScanSurface& scan, const Points3f& body, double reach, int count,
                           std::uint32_t seed);

/// Pull of the scan on a posed mesh, both directions point to surface, with compatible normals and robust
/// weights:
/// - every scan sample draws at the corners of the triangle that is closest to it, and a vertex takes the
/// mean
///   of what draws at it: noise averages out, and where nothing was scanned nothing draws;
/// - every vertex is drawn to its own closest place on the scan, unless that lies on the rim of a hole.
/// @param samples   the scan, spread evenly.
/// @param vertices  3 x V, present place, body frame, metres. @param normals  3 x V, unit, outward.
/// @param areas     V, m^2, of the mesh that the energy is taken over.
Pull pull_of_scan(const SurfaceSamples& samples, const ScanSurface& scan, const Points3f& vertices,
                  const Points3f& normals, const Faces& faces, const Eigen::VectorXd& areas,
                  const PullSettings& settings, const Execution& execution);

}  // namespace vitruvian
