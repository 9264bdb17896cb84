#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string_view>
#include <utility>

#include "body/model.h"
#include "measure/verdict_features.h"
#include "measure/verdict_model.h"

namespace vitruvian {
namespace {

// Beyond every right fit measured, of clothed people too; mm.
constexpr double kFailedModelToScan = 60, kFailedScanToModel = 150;
// From here on a number is worth a reason of its own; whether a registration is doubted is up to all of them
// together (calibrated_confidence()). mm; the second ones of bare bodies.
constexpr double kTellModelToScan = 25, kTellBareModelToScan = 15;
constexpr double kTellScanToModel = 45, kTellBareScanToModel = 20;
constexpr double kTellUnexplained = 0.05;
constexpr double kTellOpposed = 0.12, kTellBareOpposed = 0.033;
constexpr double kTellJointExcess = 0.35;   // rad, 20 degrees beyond the limit
constexpr double kTellDisagreement = 0.20;  // m
constexpr double kTellInside = 0.10;
// mm; FitScore::typical of bare bodies stays below 17.5, that of clothed ones begins at 22.
constexpr double kBareTypical = 19.5;
constexpr double kLowStature = 1.20, kHighStature = 2.20;  // m, outside of it the unit is in doubt
/// What a registration has at most that is doubted for another reason, of confidence_of_ok().
constexpr double kDoubted = 0.9;

constexpr std::size_t kMostNamed = 3;

/// Segments whose pose and size hardly suffer when they are not seen (hair, shoes and clenched fingers hide
/// them).
bool is_extremity(std::string_view segment) {
  return segment.find("hand") != std::string_view::npos || segment.find("toe") != std::string_view::npos;
}

template <typename... Values>
std::string text(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::string listed(const std::vector<std::string>& names) {
  std::string result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) result += i + 1 == names.size() ? " and " : ", ";
    result += names[i];
  }
  return result;
}

/// ", most at: left hand (31 mm) and head (20 mm)": the segments with the largest values, none below half of
/// the largest. Empty when all are 0.
std::string most_at(const std::array<double, 24>& values, const char* format, double factor = 1) {
  std::array<std::size_t, 24> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  std::vector<std::string> names;
  for (std::size_t k = 0; k < kMostNamed; ++k) {
    const double value = values[order[k]];
    if (!(value > 0) || value < values[order[0]] / 2) break;
    names.push_back(plain_name(kSegmentNames[order[k]]) + " (" + text(format, factor * value) + ")");
  }
  return names.empty() ? "" : ", most at: " + listed(names);
}

/// The worst joints beyond a limit, or when there is none the worst of all, with what `format` makes of their
/// values.
std::string worst_joints(std::vector<JointFinding> findings, double limit, const char* format,
                         double factor) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const JointFinding& a, const JointFinding& b) { return a.value > b.value; });
  std::vector<std::string> names;
  for (const JointFinding& joint : findings) {
    if (names.size() == kMostNamed || (!names.empty() && joint.value <= limit)) break;
    names.push_back(plain_name(joint.joint) + text(format, factor * joint.value));
  }
  return listed(names);
}

std::string worst_limb(const VerdictFeatures& f) {
  constexpr std::array<const char*, 4> kNames = {"left hand", "right hand", "left foot", "right foot"};
  return kNames[static_cast<std::size_t>(std::max_element(f.limb_misfit.begin(), f.limb_misfit.end()) -
                                         f.limb_misfit.begin())];
}

std::string lost_parts(const VerdictFeatures& f, bool extremities) {
  std::vector<std::string> names;
  for (std::size_t s = 0; s < kSegmentNames.size(); ++s) {
    if (f.observed_share[s] + f.unseen_share[s] < kObservedShare &&
        is_extremity(kSegmentNames[s]) == extremities)
      names.push_back(plain_name(kSegmentNames[s]));
  }
  return listed(names);
}

int lost_count(const VerdictFeatures& f) {
  int count = 0;
  for (std::size_t s = 0; s < f.observed_share.size(); ++s)
    count += f.observed_share[s] + f.unseen_share[s] < kObservedShare ? 1 : 0;
  return count;
}

/// What an input objects to, in words that name the body part.
std::string reason_for(VerdictInput input, const VerdictFeatures& f) {
  switch (input) {
    case VerdictInput::model_to_scan_p95:
    case VerdictInput::part_model_to_scan:
    case VerdictInput::uneven:
      return text("parts of the body lie where the scan has no surface: 5 %% of it is more than %.0f mm away",
                  f.model_to_scan_p95_mm) +
             most_at(f.part_model_to_scan_p95_mm, "%.0f mm");
    case VerdictInput::scan_to_model_p95:
    case VerdictInput::part_scan_to_model:
    case VerdictInput::typical:
      return text(
                 "parts of the scan are not explained by the body: 5 %% of its points lie more than %.0f mm "
                 "away (clothes, hair, another object, or a limb in the wrong place)",
                 f.scan_to_model_p95_mm) +
             most_at(f.part_scan_to_model_p95_mm, "%.0f mm");
    case VerdictInput::unexplained:
      return text("%.0f %% of the scan's points lie more than 50 mm from the body",
                  100 * f.unexplained_share) +
             most_at(f.part_unexplained_share, "%.0f %%", 100);
    case VerdictInput::opposed:
    case VerdictInput::part_opposed:
      return text(
                 "%.1f %% of the body's surface faces against the scan's: two limbs may be exchanged or a "
                 "part "
                 "turned back to front",
                 100 * f.opposed_share) +
             most_at(f.part_opposed_share, "%.0f %%", 100);
    case VerdictInput::limb_misfit:
      return "may be turned back to front or in another part's place: " +
             (f.misfit_parts.empty() ? worst_limb(f) : listed(f.misfit_parts));
    case VerdictInput::joint_limits:
      return "bent further than bodies usually do: " +
             worst_joints(f.joint_limit_excess_rad, kTellJointExcess, " (by %.0f degrees)", 57.3);
    case VerdictInput::disagreement:
      return "the fitted body is far from where the joint was detected: " +
             worst_joints(f.keypoint_disagreement_m, kTellDisagreement, " (%.0f mm)", 1e3);
    case VerdictInput::inside:
      return text("%.0f %% of the body lies inside another part of it", 100 * f.inside_share);
    case VerdictInput::lost_parts:
      return text("%d of the 24 body parts do not meet the scan", lost_count(f));
  }
  return "";
}

/// The inputs that are worth a reason each.
std::vector<VerdictInput> striking(const VerdictFeatures& f) {
  const bool bare = f.typical_mm > 0 && f.typical_mm < kBareTypical;
  const auto beyond = [](const std::vector<JointFinding>& findings, double limit) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const JointFinding& finding) { return finding.value > limit; });
  };
  std::vector<VerdictInput> found;
  if (f.scan_to_model_p95_mm > (bare ? kTellBareScanToModel : kTellScanToModel))
    found.push_back(VerdictInput::scan_to_model_p95);
  else if (f.unexplained_share > kTellUnexplained)
    found.push_back(VerdictInput::unexplained);
  if (f.model_to_scan_p95_mm > (bare ? kTellBareModelToScan : kTellModelToScan))
    found.push_back(VerdictInput::model_to_scan_p95);
  if (f.opposed_share > (bare ? kTellBareOpposed : kTellOpposed)) found.push_back(VerdictInput::opposed);
  if (!f.misfit_parts.empty()) found.push_back(VerdictInput::limb_misfit);
  if (beyond(f.joint_limit_excess_rad, kTellJointExcess)) found.push_back(VerdictInput::joint_limits);
  if (beyond(f.keypoint_disagreement_m, kTellDisagreement)) found.push_back(VerdictInput::disagreement);
  if (f.inside_share > kTellInside) found.push_back(VerdictInput::inside);
  return found;
}

/// Reasons that change nothing: what was not seen, and what was guessed.
void add_remarks(const VerdictFeatures& f, std::vector<std::string>& reasons) {
  std::vector<std::string> absent;
  for (std::size_t s = 0; s < kSegmentNames.size(); ++s) {
    if (f.observed_share[s] < kObservedShare && f.observed_share[s] + f.unseen_share[s] >= kObservedShare)
      absent.push_back(plain_name(kSegmentNames[s]));
  }
  if (!absent.empty()) reasons.push_back("not in the scan, so guessed: " + listed(absent));
  if (const std::string lost = lost_parts(f, false); !lost.empty())
    reasons.push_back("hardly seen in the scan, so mostly guessed: " + lost);
  if (const std::string lost = lost_parts(f, true); !lost.empty())
    reasons.push_back("hardly seen in the scan: " + lost);
  reasons.insert(reasons.end(), f.notes.begin(), f.notes.end());
}

}  // namespace

std::string to_string(VerdictStatus status) {
  switch (status) {
    case VerdictStatus::ok:
      return "ok";
    case VerdictStatus::doubtful:
      return "doubtful";
    case VerdictStatus::failed:
      return "failed";
  }
  return "failed";
}

std::string plain_name(std::string_view name) {
  std::string result(name);
  std::replace(result.begin(), result.end(), '_', ' ');
  return result;
}

Verdict failed_verdict(std::string reason) { return {VerdictStatus::failed, 0, {std::move(reason)}}; }

Verdict judge(const VerdictFeatures& features) {
  for (const double number : {features.model_to_scan_p95_mm, features.scan_to_model_p95_mm,
                              features.unexplained_share, features.opposed_share, features.inside_share}) {
    if (!std::isfinite(number)) return failed_verdict("the fit did not end in numbers");
  }
  Verdict verdict{VerdictStatus::ok, calibrated_confidence(features), {}};
  const int lost = lost_count(features);
  const bool apart = 2 * lost > static_cast<int>(kSegmentNames.size());
  const bool odd_stature =
      features.stature_m && (*features.stature_m < kLowStature || *features.stature_m > kHighStature);
  const bool fatal = apart || features.model_to_scan_p95_mm > kFailedModelToScan ||
                     features.scan_to_model_p95_mm > kFailedScanToModel;
  if (fatal || verdict.confidence < confidence_of_ok()) {
    verdict.status = VerdictStatus::doubtful;
    std::vector<VerdictInput> objections = striking(features);
    // Nothing strikes by itself: what weighs most.
    if (objections.empty() && !apart && !odd_stature) objections.push_back(strongest_objection(features));
    // And where to look.
    if (objections == std::vector{VerdictInput::inside} ||
        objections == std::vector{VerdictInput::joint_limits})
      objections.push_back(VerdictInput::part_model_to_scan);
    for (const VerdictInput input : objections) verdict.reasons.push_back(reason_for(input, features));
  }
  if (odd_stature) {
    verdict.status = VerdictStatus::doubtful;
    verdict.reasons.push_back(text(
        "the body would be %.2f m tall: the file's unit may be another one (--units)", *features.stature_m));
  }
  if (apart) verdict.reasons.push_back(text("%d of the 24 body parts do not meet the scan", lost));
  if (fatal) verdict.status = VerdictStatus::failed;
  if (verdict.status != VerdictStatus::ok)
    verdict.confidence = std::min(verdict.confidence, kDoubted * confidence_of_ok());
  add_remarks(features, verdict.reasons);
  return verdict;
}

}  // namespace vitruvian
