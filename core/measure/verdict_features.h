#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/surface_error_compute.h"
#include "measure/verdict.h"

namespace vitruvian {

/// One joint's number that speaks against the fit.
struct JointFinding {
  std::string joint;  ///< SMPL name
  double value = 0;
};

/// What a verdict is judged from. The defaults speak neither for nor against.
struct VerdictFeatures {
  /// 95th percentiles and means of the distances in both directions, mm. Template vertices count only in
  /// segments that were scanned.
  double model_to_scan_p95_mm = 0, model_to_scan_mean_mm = 0;
  double scan_to_model_p95_mm = 0, scan_to_model_mean_mm = 0;
  /// FitScore::typical of the fit, mm; 0 when it is not known. Tells bare bodies from clothed ones.
  double typical_mm = 0;
  double unexplained_share = 0;  ///< share of scan points farther than 50 mm from the model
  double opposed_share = 0;      ///< share of near pairs with normals against each other
  std::array<double, 24> observed_share = [] {
    std::array<double, 24> all_seen;
    all_seen.fill(1);
    return all_seen;
  }();  ///< by segment
  /// Share of each segment's vertices over a hole of the scan or beyond its rim: they say nothing about the
  /// fit.
  std::array<double, 24> unseen_share{};
  /// By segment: distances of its vertices that the scan can show, and of the scan's points nearest to it,
  /// mm; share of those points farther than 50 mm; share of its near surface that faces against the scan's. 0
  /// where there is nothing to measure.
  std::array<double, 24> part_model_to_scan_p95_mm{}, part_scan_to_model_p95_mm{};
  std::array<double, 24> part_unexplained_share{}, part_opposed_share{};
  /// Misfit of left and right hand, left and right foot: mean distance in position and normal to the scan,
  /// relative to `typical_mm`.
  std::array<double, 4> limb_misfit{};
  /// How much worse the next best distinct start fitted, mm (both directions added up); 0 when there was
  /// none.
  double runner_up_gap_mm = 0;
  int refits = 0;  ///< surface fits beyond the first that the search for a better fit took
  /// Hands and feet that do not look like the scan where they lie, though other starts were tried.
  std::vector<std::string> misfit_parts;
  std::vector<JointFinding> joint_limit_excess_rad;  ///< joints beyond their limits, by how much
  /// Distance between a confidently detected joint and the fitted one, metres.
  std::vector<JointFinding> keypoint_disagreement_m;
  double inside_share = 0;  ///< share of template vertices that lie inside another part of the body
  std::optional<double> stature_m;
  std::vector<std::string> notes;  ///< ambiguous choices made on the way (units, up), in plain words
};

/// The features that follow from a surface measurement; the others keep their defaults.
/// @param segment  one entry a template vertex, 0..23.
VerdictFeatures features_from(const SurfaceMeasurement& measurement, std::span<const std::uint8_t> segment);

/// Takes vertices that the scan cannot show out of the features: their share by segment, and the distances
/// from model to scan without them. @param unseen, segment  one entry a template vertex.
void leave_out_unseen(std::span<const std::uint8_t> unseen, std::span<const std::uint8_t> segment,
                      const SurfaceMeasurement& measurement, VerdictFeatures& features);

/// Judges a registration. `failed`: the body lies wrong beyond what clothes explain; `doubtful`: someone
/// should look, for calibrated_confidence() is low or the stature odd; `ok` otherwise. Reasons name the body
/// parts; for `ok` they only tell what was guessed or not seen.
Verdict judge(const VerdictFeatures& features);

/// Verdict of a registration that never reached a fit.
Verdict failed_verdict(std::string reason);

/// "left_upper_leg" -> "left upper leg".
std::string plain_name(std::string_view name);

}  // namespace vitruvian
