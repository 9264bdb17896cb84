#include "measure/verdict_model.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "measure/surface_error_compute.h"

namespace vitruvian {
namespace {

/// Printed by scripts/verdict_study, in the order of VerdictInput. `usual`: mean of right registrations.
constexpr double kBias = -9.6698, kConfidenceOfOk = 0.3802;
struct Weight {
  double weight, usual;
};
constexpr std::array<Weight, kVerdictInputs> kWeights = {{
    {0.9893, 0.3778},  // model_to_scan_p95
    {0.5405, 0.3205},  // scan_to_model_p95
    {1.6997, 0.9483},  // typical
    {0.3812, 0.0289},  // unexplained
    {0.0219, 0.2372},  // opposed
    {0.5575, 0.3987},  // part_model_to_scan
    {0.7686, 0.6387},  // uneven
    {0.2152, 0.3352},  // part_scan_to_model
    {0.5109, 0.2536},  // part_opposed
    {0.0000, 0.5340},  // limb_misfit
    {2.7952, 0.0259},  // joint_limits
    {0.4992, 0.4409},  // disagreement
    {0.5564, 1.1165},  // inside
    {0.6119, 0.0080},  // lost_parts
}};

double logarithm(double value, double unit) { return std::log1p(std::max(0.0, value) / unit); }

/// The largest value of the segments that meet the scan.
double worst_part(const VerdictFeatures& f, const std::array<double, 24>& values) {
  double worst = 0;
  for (std::size_t s = 0; s < values.size(); ++s) {
    if (f.observed_share[s] >= kObservedShare * (1 - f.unseen_share[s])) worst = std::max(worst, values[s]);
  }
  return worst;
}

/// The median of the segments that meet the scan; 0 when none does.
double usual_part(const VerdictFeatures& f, const std::array<double, 24>& values) {
  std::vector<double> met;
  for (std::size_t s = 0; s < values.size(); ++s) {
    if (f.observed_share[s] >= kObservedShare * (1 - f.unseen_share[s])) met.push_back(values[s]);
  }
  if (met.empty()) return 0;
  std::sort(met.begin(), met.end());
  return (met[(met.size() - 1) / 2] + met[met.size() / 2]) / 2;
}

double worst_joint(const std::vector<JointFinding>& findings) {
  double worst = 0;
  for (const JointFinding& finding : findings) worst = std::max(worst, finding.value);
  return worst;
}

int lost_parts(const VerdictFeatures& f) {
  int lost = 0;
  for (std::size_t s = 0; s < f.observed_share.size(); ++s)
    lost += f.observed_share[s] + f.unseen_share[s] < kObservedShare ? 1 : 0;
  return lost;
}

}  // namespace

std::array<double, kVerdictInputs> verdict_inputs(const VerdictFeatures& f) {
  return {logarithm(f.model_to_scan_p95_mm, 5),
          logarithm(f.scan_to_model_p95_mm, 5),
          logarithm(f.typical_mm, 10),
          logarithm(f.unexplained_share, 0.01),
          logarithm(f.opposed_share, 0.01),
          logarithm(worst_part(f, f.part_model_to_scan_p95_mm), 10),
          logarithm(worst_part(f, f.part_model_to_scan_p95_mm),
                    1 + 2 * usual_part(f, f.part_model_to_scan_p95_mm)),
          logarithm(worst_part(f, f.part_scan_to_model_p95_mm), 10),
          logarithm(worst_part(f, f.part_opposed_share), 0.1),
          logarithm(*std::max_element(f.limb_misfit.begin(), f.limb_misfit.end()), 1),
          logarithm(worst_joint(f.joint_limit_excess_rad), 0.2),
          logarithm(worst_joint(f.keypoint_disagreement_m), 0.1),
          logarithm(f.inside_share, 0.01),
          logarithm(lost_parts(f), 1)};
}

double confidence_of_ok() { return kConfidenceOfOk; }

double calibrated_confidence(const VerdictFeatures& features) {
  const auto inputs = verdict_inputs(features);
  double against = kBias;
  for (std::size_t i = 0; i < inputs.size(); ++i) against += kWeights[i].weight * inputs[i];
  return 1 / (1 + std::exp(std::min(700.0, against)));
}

VerdictInput strongest_objection(const VerdictFeatures& features) {
  const auto inputs = verdict_inputs(features);
  std::array<double, kVerdictInputs> objection{};
  for (std::size_t i = 0; i < inputs.size(); ++i)
    objection[i] = kWeights[i].weight * (inputs[i] - kWeights[i].usual);
  return static_cast<VerdictInput>(std::max_element(objection.begin(), objection.end()) - objection.begin());
}

}  // namespace vitruvian
