#include "pipeline/verdict_json.h"

#include <cmath>

#include "body/model.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;
using Features = VerdictFeatures;

struct Number {
  const char* name;
  double Features::*member;
};
constexpr Number kNumbers[] = {
    {"model_to_scan_p95_mm", &Features::model_to_scan_p95_mm},
    {"model_to_scan_mean_mm", &Features::model_to_scan_mean_mm},
    {"scan_to_model_p95_mm", &Features::scan_to_model_p95_mm},
    {"scan_to_model_mean_mm", &Features::scan_to_model_mean_mm},
    {"typical_mm", &Features::typical_mm},
    {"unexplained_share", &Features::unexplained_share},
    {"opposed_share", &Features::opposed_share},
    {"inside_share", &Features::inside_share},
    {"runner_up_gap_mm", &Features::runner_up_gap_mm},
};

struct PartNumber {
  const char* name;
  std::array<double, 24> Features::*member;
};
constexpr PartNumber kPartNumbers[] = {
    {"observed", &Features::observed_share},
    {"unseen", &Features::unseen_share},
    {"model_to_scan_p95_mm", &Features::part_model_to_scan_p95_mm},
    {"scan_to_model_p95_mm", &Features::part_scan_to_model_p95_mm},
    {"unexplained_share", &Features::part_unexplained_share},
    {"opposed_share", &Features::part_opposed_share},
};

constexpr std::array<const char*, 4> kLimbNames = {"left_hand", "right_hand", "left_foot", "right_foot"};

double rounded(double value) { return std::round(value * 1e5) / 1e5; }

ordered_json findings_to_json(const std::vector<JointFinding>& findings) {
  ordered_json result = ordered_json::object();
  for (const JointFinding& finding : findings) result[finding.joint] = rounded(finding.value);
  return result;
}

std::vector<JointFinding> findings_from_json(const JsonValue& value) {
  std::vector<JointFinding> findings;
  value.for_each_member([&](const std::string& joint, const JsonValue& member) {
    findings.push_back({joint, member.number()});
  });
  return findings;
}

void read_number(const JsonValue& value, const char* name, double& number) {
  if (value.has(name) && !value.at(name).is_null()) number = value.at(name).number();
}

}  // namespace

ordered_json features_to_json(const VerdictFeatures& features) {
  ordered_json result;
  for (const Number& number : kNumbers) result[number.name] = rounded(features.*number.member);
  result["refits"] = features.refits;
  result["stature_m"] = features.stature_m ? ordered_json(rounded(*features.stature_m)) : ordered_json();
  for (std::size_t limb = 0; limb < kLimbNames.size(); ++limb)
    result["limb_misfit"][kLimbNames[limb]] = rounded(features.limb_misfit[limb]);
  result["joint_limit_excess_rad"] = findings_to_json(features.joint_limit_excess_rad);
  result["keypoint_disagreement_m"] = findings_to_json(features.keypoint_disagreement_m);
  result["segments"] = ordered_json::array();
  for (std::size_t s = 0; s < kSegmentNames.size(); ++s) {
    ordered_json row;
    row["segment"] = kSegmentNames[s];
    for (const PartNumber& number : kPartNumbers) row[number.name] = rounded((features.*number.member)[s]);
    result["segments"].push_back(std::move(row));
  }
  return result;
}

VerdictFeatures features_from_json(const JsonValue& value) {
  VerdictFeatures features;
  for (const Number& number : kNumbers) read_number(value, number.name, features.*number.member);
  if (value.has("refits")) features.refits = static_cast<int>(value.at("refits").whole(0, 1000000));
  if (value.has("stature_m") && !value.at("stature_m").is_null())
    features.stature_m = value.at("stature_m").number();
  if (value.has("limb_misfit")) {
    for (std::size_t limb = 0; limb < kLimbNames.size(); ++limb)
      read_number(value.at("limb_misfit"), kLimbNames[limb], features.limb_misfit[limb]);
  }
  if (value.has("joint_limit_excess_rad"))
    features.joint_limit_excess_rad = findings_from_json(value.at("joint_limit_excess_rad"));
  if (value.has("keypoint_disagreement_m"))
    features.keypoint_disagreement_m = findings_from_json(value.at("keypoint_disagreement_m"));
  if (value.has("segments")) {
    const JsonValue rows = value.at("segments");
    for (std::size_t s = 0; s < std::min(rows.size(), kSegmentNames.size()); ++s) {
      for (const PartNumber& number : kPartNumbers)
        read_number(rows.at(s), number.name, (features.*number.member)[s]);
    }
  }
  return features;
}

}  // namespace vitruvian
