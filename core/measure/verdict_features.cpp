#include "measure/verdict_features.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string_view>
#include <utility>

#include "body/model.h"
#include "measure/statistics.h"

namespace vitruvian {
namespace {

constexpr float kUnexplainedDistance = 0.050f;

// Two-way residuals that called every wrong fit of clothed strangers and a tenth of the right ones; the
// second pair lies beyond every right fit measured.
constexpr double kDoubtfulModelToScan = 25, kFailedModelToScan = 60;
constexpr double kDoubtfulScanToModel = 45, kFailedScanToModel = 150;
// Of bare bodies no right fit measured goes beyond 6 mm from model to scan and 8 mm back.
constexpr double kBareModelToScan = 15, kBareScanToModel = 20;
// Right fits of bare bodies stay under 3.0 % opposed normals, of clothed ones under 12 %.
constexpr double kBareOpposed = 0.033, kClothedOpposed = 0.12;
// mm; bare bodies stay below 17.5, clothed ones begin at 22. The second tells when the first is not known.
constexpr double kBareTypical = 19.5, kBareScanToModelAlone = 26;
constexpr double kLargestUnseen = 0.05;  // mean share over the segments
constexpr double kDoubtfulUnexplained = 0.05;
constexpr double kDoubtfulJointExcess = 0.35;   // rad, 20 degrees beyond the limit
constexpr double kDoubtfulDisagreement = 0.20;  // m, several times the detector's own error
// Every right fit of a bare body stays below it in both directions, no wrong one measured does: the detector,
// which a hand behind an arm misleads by 30 cm, has nothing to say against such a fit. mm.
constexpr double kSnug = 8;
constexpr double kDoubtfulInside = 0.04;
constexpr double kLowStature = 1.20, kHighStature = 2.20;  // m, outside of it the unit is in doubt

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

bool is_bare(const VerdictFeatures& f) {
  return f.typical_mm > 0 ? f.typical_mm < kBareTypical : f.scan_to_model_p95_mm < kBareScanToModelAlone;
}

/// Share of opposed normals that speaks against a fit. Of thin parts scanned from one side alone the other
/// side is near and faces away.
double opposed_limit(const VerdictFeatures& f) {
  const double unseen = std::accumulate(f.unseen_share.begin(), f.unseen_share.end(), 0.0) / 24;
  return is_bare(f) && unseen < kLargestUnseen ? kBareOpposed : kClothedOpposed;
}

/// How the scan's points lie off the body, by the segment nearest to each.
void add_points_of_parts(const SurfaceMeasurement& measurement, std::span<const std::uint8_t> segment,
                         VerdictFeatures& f) {
  std::array<std::vector<float>, 24> distances;
  std::array<int, 24> far{};
  for (std::size_t k = 0; k < measurement.sampled_vertex.size(); ++k) {
    const std::size_t s = segment[static_cast<std::size_t>(measurement.sampled_vertex[k])];
    distances[s].push_back(measurement.sampled_distance_m[k]);
    far[s] += measurement.sampled_distance_m[k] > kUnexplainedDistance ? 1 : 0;
  }
  for (std::size_t s = 0; s < distances.size(); ++s) {
    if (distances[s].empty()) continue;
    f.part_unexplained_share[s] = static_cast<double>(far[s]) / static_cast<double>(distances[s].size());
    f.part_scan_to_model_p95_mm[s] = distance_statistics(std::move(distances[s])).p95_mm;
  }
}

double scan_to_model_limit(const VerdictFeatures& f) {
  return f.typical_mm > 0 && is_bare(f) ? kBareScanToModel : kDoubtfulScanToModel;
}

double model_to_scan_limit(const VerdictFeatures& f) {
  return f.typical_mm > 0 && is_bare(f) ? kBareModelToScan : kDoubtfulModelToScan;
}

/// Whether scan and body lie on each other everywhere, their normals too.
bool is_snug(const VerdictFeatures& f) {
  return f.model_to_scan_p95_mm < kSnug && f.scan_to_model_p95_mm < kSnug &&
         f.opposed_share < opposed_limit(f);
}

/// Collects findings; the worst status wins.
class Findings {
 public:
  void add(VerdictStatus status, std::string reason) {
    verdict_.status = std::max(verdict_.status, status);
    verdict_.reasons.push_back(std::move(reason));
  }
  Verdict take(double confidence) {
    verdict_.confidence = confidence;
    return std::move(verdict_);
  }

 private:
  Verdict verdict_{VerdictStatus::ok, 0, {}};
};

void judge_residuals(const VerdictFeatures& f, Findings& findings) {
  if (f.scan_to_model_p95_mm > scan_to_model_limit(f)) {
    findings.add(
        f.scan_to_model_p95_mm > kFailedScanToModel ? VerdictStatus::failed : VerdictStatus::doubtful,
        text("parts of the scan are not explained by the body: 5 %% of its points lie more than %.0f mm away "
             "(clothes, hair, another object, or a limb in the wrong place)",
             f.scan_to_model_p95_mm));
  } else if (f.unexplained_share > kDoubtfulUnexplained) {
    findings.add(
        VerdictStatus::doubtful,
        text("%.0f %% of the scan's points lie more than 50 mm from the body", 100 * f.unexplained_share));
  }
  if (f.model_to_scan_p95_mm > model_to_scan_limit(f)) {
    findings.add(
        f.model_to_scan_p95_mm > kFailedModelToScan ? VerdictStatus::failed : VerdictStatus::doubtful,
        text("parts of the body lie where the scan has no surface: 5 %% of it is more than %.0f mm away",
             f.model_to_scan_p95_mm));
  }
  if (f.opposed_share > opposed_limit(f)) {
    findings.add(
        VerdictStatus::doubtful,
        text("%.1f %% of the body's surface faces against the scan's: two limbs may be exchanged or a part "
             "turned back to front",
             100 * f.opposed_share));
  }
}

void judge_parts(const VerdictFeatures& f, Findings& findings) {
  if (f.misfit_parts.empty()) return;
  findings.add(VerdictStatus::doubtful,
               "may be turned back to front or in another part's place: " + listed(f.misfit_parts));
}

void judge_coverage(const VerdictFeatures& f, Findings& findings) {
  std::vector<std::string> major, minor, absent;
  for (std::size_t s = 0; s < kSegmentNames.size(); ++s) {
    if (f.observed_share[s] >= kObservedShare) continue;
    if (f.observed_share[s] + f.unseen_share[s] >= kObservedShare) {
      absent.push_back(plain_name(kSegmentNames[s]));
      continue;
    }
    (is_extremity(kSegmentNames[s]) ? minor : major).push_back(plain_name(kSegmentNames[s]));
  }
  if (2 * (major.size() + minor.size()) > kSegmentNames.size()) {
    findings.add(VerdictStatus::failed, text("%d of the 24 body parts do not meet the scan",
                                             static_cast<int>(major.size() + minor.size())));
  } else if (!major.empty()) {
    findings.add(VerdictStatus::doubtful, "hardly seen in the scan, so mostly guessed: " + listed(major));
  }
  if (!absent.empty()) findings.add(VerdictStatus::ok, "not in the scan, so guessed: " + listed(absent));
  if (!minor.empty()) findings.add(VerdictStatus::ok, "hardly seen in the scan: " + listed(minor));
}

void judge_joints(const VerdictFeatures& f, Findings& findings) {
  std::vector<std::string> beyond, away;
  for (const JointFinding& joint : f.joint_limit_excess_rad) {
    if (joint.value > kDoubtfulJointExcess) beyond.push_back(plain_name(joint.joint));
  }
  if (!beyond.empty()) {
    findings.add(VerdictStatus::doubtful, "bent further than bodies usually do: " + listed(beyond));
  }
  for (const JointFinding& joint : f.keypoint_disagreement_m) {
    if (joint.value > kDoubtfulDisagreement && !is_snug(f)) {
      away.push_back(plain_name(joint.joint) + text(" (%.0f mm)", 1e3 * joint.value));
    }
  }
  if (!away.empty()) {
    findings.add(VerdictStatus::doubtful,
                 "the fitted body is far from where the joint was detected: " + listed(away));
  }
  if (f.inside_share > kDoubtfulInside) {
    findings.add(VerdictStatus::doubtful,
                 text("%.0f %% of the body lies inside another part of it", 100 * f.inside_share));
  }
}

/// 1 well below `doubtful`, 1/2 there, 0 far above.
double trust(double value, double doubtful) { return 1 / (1 + std::pow(std::max(0.0, value) / doubtful, 4)); }

double confidence_of(const VerdictFeatures& f) {
  double confidence =
      trust(f.scan_to_model_p95_mm, scan_to_model_limit(f)) *
      trust(f.model_to_scan_p95_mm, model_to_scan_limit(f)) * trust(f.opposed_share, opposed_limit(f)) *
      trust(f.unexplained_share, kDoubtfulUnexplained) * trust(f.inside_share, kDoubtfulInside);
  double excess = 0, disagreement = 0, seen = 0;
  for (const JointFinding& joint : f.joint_limit_excess_rad) excess = std::max(excess, joint.value);
  if (!is_snug(f)) {
    for (const JointFinding& joint : f.keypoint_disagreement_m)
      disagreement = std::max(disagreement, joint.value);
  }
  for (std::size_t s = 0; s < f.observed_share.size(); ++s)
    seen += std::min(1.0, (f.observed_share[s] + f.unseen_share[s]) / kObservedShare) / 24;
  if (!f.misfit_parts.empty()) confidence *= 0.5;
  confidence *= trust(excess, kDoubtfulJointExcess) * trust(disagreement, kDoubtfulDisagreement) * seen;
  return std::clamp(confidence, 0.0, 1.0);
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

VerdictFeatures features_from(const SurfaceMeasurement& measurement, std::span<const std::uint8_t> segment) {
  VerdictFeatures f;
  const SurfaceError& error = measurement.error;
  f.model_to_scan_p95_mm = error.surface_all.p95_mm;
  f.model_to_scan_mean_mm = error.surface_all.mean_mm;
  f.scan_to_model_p95_mm = error.scan_to_model.p95_mm;
  f.scan_to_model_mean_mm = error.scan_to_model.mean_mm;
  f.opposed_share = measurement.opposed_share;
  const std::vector<float>& distances = measurement.sampled_distance_m;
  if (!distances.empty()) {
    const auto far =
        std::count_if(distances.begin(), distances.end(), [](float d) { return d > kUnexplainedDistance; });
    f.unexplained_share = static_cast<double>(far) / static_cast<double>(distances.size());
  }
  for (std::size_t s = 0; s < error.surface_segments.size() && s < f.observed_share.size(); ++s) {
    f.observed_share[s] = error.surface_segments[s].observed;
    if (const auto& own = error.surface_segments[s].statistics) f.part_model_to_scan_p95_mm[s] = own->p95_mm;
  }
  std::copy_n(measurement.segment_opposed_share.begin(),
              std::min(measurement.segment_opposed_share.size(), f.part_opposed_share.size()),
              f.part_opposed_share.begin());
  add_points_of_parts(measurement, segment, f);
  return f;
}

void leave_out_unseen(std::span<const std::uint8_t> unseen, std::span<const std::uint8_t> segment,
                      const SurfaceMeasurement& measurement, VerdictFeatures& features) {
  std::array<int, 24> count{}, hidden{};
  for (std::size_t v = 0; v < unseen.size(); ++v) {
    ++count[segment[v]];
    hidden[segment[v]] += unseen[v] != 0 ? 1 : 0;
  }
  if (std::all_of(hidden.begin(), hidden.end(), [](int n) { return n == 0; })) return;
  std::vector<float> distances;
  std::array<std::vector<float>, 24> of_part;
  for (std::size_t s = 0; s < count.size(); ++s)
    features.unseen_share[s] = count[s] > 0 ? static_cast<double>(hidden[s]) / count[s] : 0;
  for (std::size_t v = 0; v < unseen.size(); ++v) {
    const std::size_t s = segment[v];
    const double shown = 1 - features.unseen_share[s];
    if (unseen[v] == 0 && features.observed_share[s] >= kObservedShare * shown) {
      distances.push_back(measurement.surface_distance_m[v]);
      of_part[s].push_back(measurement.surface_distance_m[v]);
    }
  }
  for (std::size_t s = 0; s < of_part.size(); ++s)
    features.part_model_to_scan_p95_mm[s] = distance_statistics(std::move(of_part[s])).p95_mm;
  const DistanceStatistics statistics = distance_statistics(std::move(distances));
  features.model_to_scan_p95_mm = statistics.p95_mm;
  features.model_to_scan_mean_mm = statistics.mean_mm;
}

Verdict judge(const VerdictFeatures& features) {
  for (const double number : {features.model_to_scan_p95_mm, features.scan_to_model_p95_mm,
                              features.opposed_share, features.unexplained_share, features.inside_share}) {
    if (!std::isfinite(number)) return failed_verdict("the fit did not end in numbers");
  }
  Findings findings;
  judge_residuals(features, findings);
  judge_parts(features, findings);
  judge_coverage(features, findings);
  judge_joints(features, findings);
  if (features.stature_m && (*features.stature_m < kLowStature || *features.stature_m > kHighStature)) {
    findings.add(VerdictStatus::doubtful,
                 text("the body would be %.2f m tall: the file's unit may be another one (--units)",
                      *features.stature_m));
  }
  for (const std::string& note : features.notes) findings.add(VerdictStatus::ok, note);
  return findings.take(confidence_of(features));
}

}  // namespace vitruvian
