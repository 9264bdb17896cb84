#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fit/landmark_fit.h"
#include "fit/surface_fit.h"

namespace vitruvian {

/// When a fit counts as bad, and how much may be spent on finding a better one. Budgets are counts, not
/// times, so that a result never depends on the machine's speed.
struct HypothesisSettings {
  /// A fit whose FitScore::typical is below this is one of a bare body, m. Right fits of bare bodies stay
  /// below 0.0175, those of clothed ones and of other people begin at 0.022.
  double bare_typical = 0.0195;
  /// A fit beyond either is searched for misplaced limbs; m.
  double bad_scan_to_model_p95 = 0.045, bad_model_to_scan_p95 = 0.025;
  double bad_bare_scan_to_model_p95 = 0.026, bad_bare_model_to_scan_p95 = 0.014;
  /// A bare scan is explained to the last hand: beyond either its fit is bad, m.
  double bad_bare_scan_to_model_p99 = 0.035, bad_bare_model_to_scan_p99 = 0.020;
  /// Share of opposed normals beyond which two limbs may lie in each other's place. Right fits of bare bodies
  /// reach 3.0 %, of clothed ones 12 %.
  double bad_opposed_bare = 0.030, bad_opposed_clothed = 0.12;
  /// A fit that is still beyond this, or beyond bad_model_to_scan_p95, is started anew; m. Between the two
  /// lie clothes and hair: scan points without a counterpart on a body that is otherwise explained.
  double hopeless_scan_to_model_p95 = 0.09;
  /// Times FitScore::typical: extremity_misfit() beyond which a hand or foot is tried back to front. Right
  /// ones of bare bodies reach 0.7, shoes 1.
  double bad_extremity = 1.1, bad_bare_extremity = 0.8;
  int repair_rounds = 3;
  int candidates_per_limb = 2;
  double least_gain = 0.001;              ///< m of FitScore::total()
  double least_turn_gain = 0.0001;        ///< the same for a hand or foot of a bare body
  int refit_budget = 48;                  ///< coarse surface fits beyond the first
  int small_part_budget = 8;              ///< of it, for other starts when no whole limb is away
  double same_pose = 0.06;                ///< m, largest joint distance at which two starts count as one
  std::optional<BodyState> landmark_fit;  ///< of the first start, when it was done before
};

struct HypothesisResult {
  BodyState state;
  FitScore score;
  bool bad = false;  ///< still over a threshold
  /// Whether whole limbs are away from the scan: one of the thresholds at the 95th percentile.
  bool limb_away = false;
  std::array<bool, 4> misfit_limbs{};  ///< hands and feet, as kLimbs, that do not look like the scan there
  /// extremity_misfit() of hands and feet, times FitScore::typical.
  std::array<double, 4> limb_misfit{};
  std::string start;  ///< name of the start that led here, e.g. "landmarks", "legs exchanged"
  int repairs = 0;    ///< limbs found again
  int turned = 0;     ///< hands and feet turned round
  int refits = 0;     ///< surface fits beyond the first
  double runner_up_gap =
      0;  ///< m, total() of the next best distinct start minus ours; 0 when only one was tried
};

/// Fits from the landmarks; when the two-way residual is bad, searches limbs anew where scan points stay
/// unexplained, then tries other starts: the plain triangulation, and landmarks with left and right exchanged
/// on legs, arms, forearms, shanks or all. Hands and feet that fit badly are tried back to front.
/// @param landmarks  swap-aware triangulation; `plain` the other one (may be empty).
HypothesisResult fit_hypotheses(const FitModel& model, const ScanTarget& scan,
                                const std::vector<LandmarkTarget>& landmarks,
                                const std::vector<LandmarkTarget>& plain, const HypothesisSettings& settings,
                                const Execution& execution);

/// Fits from one given state, without trying others; limbs are searched anew as there.
/// @param landmarks  may be empty.
/// @param name  recorded as HypothesisResult::start.
HypothesisResult fit_from_state(const FitModel& model, const ScanTarget& scan, const BodyState& start,
                                const std::string& name, const std::vector<LandmarkTarget>& landmarks,
                                const HypothesisSettings& settings, const Execution& execution);

/// The landmark on the other side of the body, or the landmark itself (nose).
int mirrored_landmark(int landmark);

}  // namespace vitruvian
