#pragma once

#include <array>
#include <span>
#include <vector>

#include "fit/fit_observer.h"
#include "fit/normal_equations.h"
#include "fit/scan_target.h"

namespace vitruvian {

/// One stage of the annealed fit. Weights multiply dimensionless terms.
struct FitStage {
  int iterations;
  int samples;         ///< points a direction
  double sigma_begin;  ///< m, robust scale, falls geometrically to sigma_end
  double sigma_end;
  double isotropy;         ///< weight of the whole distance beside the distance along the normal
  double gaussian;         ///< pose prior
  double limits;           ///< joint limits
  double shape;            ///< shape prior
  double landmarks;        ///< landmark term
  bool normals_in_search;  ///< neighbours by position and normal
  bool from_scan = true;   ///< scan points pull at the model too; false: one direction only
};

struct FitSchedule {
  std::vector<FitStage> stages;
  /// From a landmark fit to the surface (measured best; about 36 iterations).
  static FitSchedule full();
  /// The first two stages of full(): enough to tell hypotheses apart.
  static FitSchedule coarse();
  /// From a re-posed limb: starts narrower, shorter and without landmarks; as exact as coarse().
  static FitSchedule after_limb_search();
  /// What coarse() leaves out.
  static FitSchedule polish();
};

/// How well a body explains a scan and the scan a body; distances between samples, m. Parts of the body over
/// a hole of the scan or beyond its rim do not count.
struct FitScore {
  /// Means of the distances in position and normal (ScanTarget::kNormalWeight): two limbs that lie in each
  /// other's place are near to the scan's points, but not to points that face their way.
  double model_to_scan = 0;
  double scan_to_model = 0;
  double model_to_scan_p95 = 0;  ///< of the distances in position alone
  double scan_to_model_p95 = 0;
  double model_to_scan_p99 = 0;  ///< a hand holds a hundredth of the surface
  double scan_to_model_p99 = 0;
  /// Sum of the medians of the distances in position and normal: how alike the two surfaces are where they
  /// meet. A limb that lies elsewhere hardly moves it; clothes and noise do.
  double typical = 0;
  double opposed_normals = 0;  ///< share of the nearest pairs whose normals point away from each other
  double total() const { return model_to_scan + scan_to_model; }
};

/// Annealed Gauss-Newton fit of pose, shape and translation to the scan: point-to-plane in both directions,
/// robust (Geman-McClure) weights, normal compatibility.
void fit_surface(const FitModel& model, const ScanTarget& scan, const FitSchedule& schedule,
                 std::span<const LandmarkTarget> landmarks, BodyState& state, const Execution& execution,
                 const FitObserver& each = {});

/// Two-way distances over `samples` points a direction.
FitScore score_fit(const FitModel& model, const ScanTarget& scan, const BodyState& state, int samples = 4000);

}  // namespace vitruvian
