#include <limits>

#include "base/error.h"
#include "pipeline/result_json.h"
#include "pipeline/result_json_value.h"
#include "pipeline/settings_json.h"
#include "pipeline/settings_names.h"
#include "pipeline/verdict_json.h"

namespace vitruvian {
namespace {

constexpr std::int64_t kLargestCount = std::numeric_limits<std::int32_t>::max();

/// A number or null, which is 0.
double number_or_zero(const JsonValue& value) { return value.is_null() ? 0 : value.number(); }

DistanceStatistics read_statistics(const JsonValue& value) {
  DistanceStatistics s;
  s.count = value.at("count").is_null() ? 0 : static_cast<int>(value.at("count").whole(0, kLargestCount));
  s.mean_mm = number_or_zero(value.at("mean_mm"));
  s.std_mm = number_or_zero(value.at("std_mm"));
  s.median_mm = number_or_zero(value.at("median_mm"));
  s.p95_mm = number_or_zero(value.at("p95_mm"));
  s.max_mm = number_or_zero(value.at("max_mm"));
  return s;
}

std::vector<SegmentError> read_segments(const JsonValue& value) {
  std::vector<SegmentError> result;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const JsonValue row = value.at(i);
    SegmentError segment;
    segment.segment = row.at("segment").text();
    segment.observed = row.at("observed").number();
    if (!row.at("count").is_null()) segment.statistics = read_statistics(row);
    result.push_back(std::move(segment));
  }
  return result;
}

SurfaceError read_surface_error(const JsonValue& value) {
  SurfaceError error;
  error.observed = value.at("surface_all").at("observed").number();
  error.segments = read_segments(value.at("segments"));
  error.all = read_statistics(value.at("all"));
  error.surface_segments = read_segments(value.at("surface_segments"));
  error.surface_all = read_statistics(value.at("surface_all"));
  const JsonValue back = value.at("scan_to_model");
  error.scan_to_model.mean_mm = number_or_zero(back.at("mean_mm"));
  error.scan_to_model.median_mm = number_or_zero(back.at("median_mm"));
  error.scan_to_model.p95_mm = number_or_zero(back.at("p95_mm"));
  error.scan_to_model.max_mm = number_or_zero(back.at("max_mm"));
  return error;
}

Alignment read_alignment(const JsonValue& document) {
  Alignment alignment;
  const JsonValue value = document.at("alignment");
  if (value.is_null()) return alignment;
  alignment.body_from_scan = value.at("body_from_scan").matrix4();
  alignment.canonical_from_body = value.at("canonical_from_body").matrix4();
  alignment.up = value.at("up").text();
  alignment.front = value.at("front").text();
  alignment.method = value.at("method").text();
  alignment.unit = named<Unit>(document.at("scan").at("unit"));
  alignment.metres_per_unit = document.at("scan").at("metres_per_unit").number();
  return alignment;
}

std::vector<Keypoint> read_keypoints(const JsonValue& value) {
  std::vector<Keypoint> result;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const JsonValue row = value.at(i);
    Keypoint keypoint;
    keypoint.joint = row.at("joint").text();
    if (!row.at("position_m").is_null()) keypoint.position_m = row.at("position_m").vector3();
    keypoint.confidence = number_or_zero(row.at("confidence"));
    const std::string source = row.at("source").text();
    bool known = false;
    for (const KeypointSource candidate :
         {KeypointSource::detected, KeypointSource::derived, KeypointSource::user, KeypointSource::none}) {
      if (source != to_string(candidate)) continue;
      keypoint.source = candidate;
      known = true;
    }
    if (!known) row.at("source").fail("one of detected derived user none is expected");
    result.push_back(std::move(keypoint));
  }
  return result;
}

Timing read_timing(const JsonValue& value) {
  Timing timing;
  timing.read = number_or_zero(value.at("read"));
  timing.align = number_or_zero(value.at("align"));
  timing.project = number_or_zero(value.at("project"));
  timing.detect = number_or_zero(value.at("detect"));
  timing.pose = number_or_zero(value.at("pose"));
  timing.fit = number_or_zero(value.at("fit"));
  timing.refine = number_or_zero(value.at("refine"));
  timing.detail = number_or_zero(value.at("detail"));
  timing.write = number_or_zero(value.at("write"));
  timing.total = number_or_zero(value.at("total"));
  return timing;
}

VerdictStatus read_status(const JsonValue& value) {
  const std::string name = value.text();
  for (const VerdictStatus status : {VerdictStatus::ok, VerdictStatus::doubtful, VerdictStatus::failed}) {
    if (name == to_string(status)) return status;
  }
  value.fail("one of ok doubtful failed is expected");
}

}  // namespace

Registration parse_registration(std::string_view text, const std::string& file_name) {
  const nlohmann::json json = parse_json(text, file_name);
  const JsonValue document(json, file_name, "");
  if (!document.has("vitruvian")) document.fail("this is no registration.json: \"vitruvian\" is missing");
  Registration registration;

  const JsonValue scan = document.at("scan");
  registration.scan.file = scan.at("file").text();
  registration.scan.sha256 = scan.at("sha256").text();
  registration.scan.vertices = scan.at("vertices").whole(0, kLargestCount);
  registration.scan.faces = scan.at("faces").whole(0, kLargestCount);

  const JsonValue model = document.at("model");
  registration.model.name = model.at("name").text();
  registration.model.family = model.at("family").text();
  registration.model.gender = named<Gender>(model.at("gender"));
  registration.model.vertices = static_cast<int>(model.at("vertices").whole(0, kLargestCount));
  registration.model.faces = static_cast<int>(model.at("faces").whole(0, kLargestCount));
  registration.model.betas = static_cast<int>(model.at("betas").whole(0, kLargestCount));
  registration.model.joints = static_cast<int>(model.at("joints").whole(0, kLargestCount));
  registration.model.sha256 = model.at("sha256").text();
  const auto users_file = [&](const char* name) -> std::optional<FileInfo> {
    if (!model.has(name)) return std::nullopt;
    return FileInfo{model.at(name).at("file").text(), model.at(name).at("sha256").text()};
  };
  registration.model.dmpl = users_file("dmpl");
  registration.model.prior = users_file("prior");

  registration.alignment = read_alignment(document);
  registration.keypoints = read_keypoints(document.at("keypoints"));
  if (!document.at("parameters").is_null())
    registration.parameters = parameters_from_json(document.at("parameters"));
  const JsonValue joints = document.at("joints");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JsonValue joint = joints.at(i);
    registration.joints.push_back(
        {joint.at("name").text(), joint.at("body_m").vector3(), joint.at("scan").vector3()});
  }
  if (!document.at("surface_error").is_null()) {
    const JsonValue error = document.at("surface_error");
    registration.surface_error = read_surface_error(error);
    if (error.has("parametric")) registration.parametric_error = read_surface_error(error.at("parametric"));
  }
  const JsonValue verdict = document.at("verdict");
  registration.verdict.status = read_status(verdict.at("status"));
  registration.verdict.confidence = number_or_zero(verdict.at("confidence"));
  const JsonValue reasons = verdict.at("reasons");
  for (std::size_t i = 0; i < reasons.size(); ++i)
    registration.verdict.reasons.push_back(reasons.at(i).text());
  if (verdict.has("features")) registration.verdict_features = features_from_json(verdict.at("features"));
  registration.timing_ms = read_timing(document.at("timing_ms"));
  registration.settings = settings_from_json(document.at("settings"));
  return registration;
}

}  // namespace vitruvian
