#pragma once

#include "fit/surface_fit.h"
#include "geometry/scan_surface.h"

namespace vitruvian {

struct RefineSettings {
  int iterations = 8;
  int scan_samples = 6000;
  double sigma_begin = 0.008;  ///< m
  double sigma_end = 0.004;
  double gaussian = 0.0005;
  double limits = 0.05;
  double shape = 0.001;
};

/// Last Gauss-Newton steps against the surface itself instead of samples of it: every template vertex to the
/// closest point on the scan's triangles (local plane for clouds), and scan samples to the closest point on
/// the model's triangles; point-to-plane, area-weighted, robust.
/// @param regions  labels of the scan's own vertices; pairs that cross labels do not count.
void refine_fit(const FitModel& model, const ScanSurface& surface, const ScanTarget& samples,
                const RefineSettings& settings, BodyState& state, const Execution& execution,
                const RegionLabels& regions = {});

}  // namespace vitruvian
