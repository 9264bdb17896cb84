#pragma once

#include <array>

#include "measure/verdict_features.h"

namespace vitruvian {

/// What the confidence is computed from. Each grows with what speaks against a fit, but for `typical`:
/// clothes excuse some distance.
enum class VerdictInput {
  model_to_scan_p95,
  scan_to_model_p95,
  typical,
  unexplained,
  opposed,
  part_model_to_scan,
  uneven,  ///< the worst segment's distance, relative to the usual one's
  part_scan_to_model,
  part_opposed,
  limb_misfit,
  joint_limits,
  disagreement,
  inside,
  lost_parts,
};
constexpr std::size_t kVerdictInputs = 14;

/// The inputs of a registration; logarithms, so that none outweighs all others.
std::array<double, kVerdictInputs> verdict_inputs(const VerdictFeatures& features);

/// From this confidence on a registration is told ok.
double confidence_of_ok();

/// Probability that a registration is right, were right and wrong ones equally frequent: logistic in the
/// inputs. Weights and threshold are printed by scripts/verdict_study, which says what they were calibrated
/// on; docs/accuracy.md says how well they do on other scans.
double calibrated_confidence(const VerdictFeatures& features);

/// The input that speaks loudest against a registration, compared with what right ones have.
VerdictInput strongest_objection(const VerdictFeatures& features);

}  // namespace vitruvian
