#include "pipeline/result_json.h"

#include <cmath>

#include "pipeline/result_json_value.h"
#include "pipeline/settings_json.h"
#include "pipeline/verdict_json.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

double rounded(double value, double digits_factor) {
  return std::round(value * digits_factor) / digits_factor;
}
double millimetres(double value) { return rounded(value, 1e4); }

void add_statistics(ordered_json& object, const DistanceStatistics* statistics) {
  const bool known = statistics != nullptr && statistics->count > 0;
  const auto value = [&](double DistanceStatistics::*member) {
    return known ? ordered_json(millimetres(statistics->*member)) : ordered_json();
  };
  object["count"] = statistics != nullptr ? ordered_json(statistics->count) : ordered_json();
  object["mean_mm"] = value(&DistanceStatistics::mean_mm);
  object["std_mm"] = value(&DistanceStatistics::std_mm);
  object["median_mm"] = value(&DistanceStatistics::median_mm);
  object["p95_mm"] = value(&DistanceStatistics::p95_mm);
  object["max_mm"] = value(&DistanceStatistics::max_mm);
}

ordered_json segment_rows(const std::vector<SegmentError>& segments) {
  ordered_json result = ordered_json::array();
  for (const SegmentError& segment : segments) {
    ordered_json row;
    row["segment"] = segment.segment;
    row["observed"] = rounded(segment.observed, 1e4);
    add_statistics(row, segment.statistics ? &*segment.statistics : nullptr);
    result.push_back(std::move(row));
  }
  return result;
}

ordered_json pooled(double observed, const DistanceStatistics& statistics) {
  ordered_json result;
  result["observed"] = rounded(observed, 1e4);
  add_statistics(result, &statistics);
  return result;
}

ordered_json surface_error_json(const SurfaceError& error) {
  ordered_json result;
  result["segments"] = segment_rows(error.segments);
  result["all"] = pooled(error.observed, error.all);
  result["surface_segments"] = segment_rows(error.surface_segments);
  result["surface_all"] = pooled(error.observed, error.surface_all);
  result["scan_to_model"] = {{"mean_mm", millimetres(error.scan_to_model.mean_mm)},
                             {"median_mm", millimetres(error.scan_to_model.median_mm)},
                             {"p95_mm", millimetres(error.scan_to_model.p95_mm)},
                             {"max_mm", millimetres(error.scan_to_model.max_mm)}};
  return result;
}

ordered_json scan_json(const Registration& registration) {
  const bool aligned = !registration.alignment.method.empty();
  ordered_json result;
  result["file"] = registration.scan.file;
  result["sha256"] = registration.scan.sha256;
  result["vertices"] = registration.scan.vertices;
  result["faces"] = registration.scan.faces;
  result["unit"] = aligned ? ordered_json(to_string(registration.alignment.unit)) : ordered_json();
  result["metres_per_unit"] = aligned ? ordered_json(registration.alignment.metres_per_unit) : ordered_json();
  return result;
}

ordered_json model_json(const ModelInfo& model) {
  ordered_json result;
  result["name"] = model.name;
  result["family"] = model.family;
  result["gender"] = name_of(model.gender);
  result["vertices"] = model.vertices;
  result["faces"] = model.faces;
  result["betas"] = model.betas;
  result["joints"] = model.joints;
  result["sha256"] = model.sha256;
  const auto add_file = [&](const char* name, const std::optional<FileInfo>& info) {
    if (info) result[name] = {{"file", info->file}, {"sha256", info->sha256}};
  };
  add_file("dmpl", model.dmpl);
  add_file("prior", model.prior);
  return result;
}

ordered_json alignment_json(const Alignment& alignment) {
  if (alignment.method.empty()) return nullptr;
  ordered_json result;
  result["body_from_scan"] = rows(alignment.body_from_scan);
  result["canonical_from_body"] = rows(alignment.canonical_from_body);
  result["up"] = alignment.up;
  result["front"] = alignment.front;
  result["method"] = alignment.method;
  return result;
}

ordered_json keypoint_rows(const std::vector<Keypoint>& keypoints) {
  ordered_json result = ordered_json::array();
  for (const Keypoint& keypoint : keypoints) {
    ordered_json row;
    row["joint"] = keypoint.joint;
    row["position_m"] = keypoint.position_m ? numbers(*keypoint.position_m) : ordered_json();
    row["confidence"] = rounded(keypoint.confidence, 1e4);
    row["source"] = to_string(keypoint.source);
    result.push_back(std::move(row));
  }
  return result;
}

ordered_json parameters_json(const std::optional<BodyParameters>& parameters) {
  return parameters ? parameters_to_json(*parameters) : ordered_json();
}

ordered_json joint_rows(const std::vector<RegisteredJoint>& joints) {
  ordered_json result = ordered_json::array();
  for (const RegisteredJoint& joint : joints) {
    result.push_back(
        {{"name", joint.name}, {"body_m", numbers(joint.body_m)}, {"scan", numbers(joint.scan)}});
  }
  return result;
}

ordered_json timing_json(const Timing& timing) {
  ordered_json result;
  const auto add = [&](const char* stage, double milliseconds) { result[stage] = rounded(milliseconds, 10); };
  add("read", timing.read);
  add("align", timing.align);
  add("project", timing.project);
  add("detect", timing.detect);
  add("pose", timing.pose);
  add("fit", timing.fit);
  add("refine", timing.refine);
  add("detail", timing.detail);
  add("write", timing.write);
  add("total", timing.total);
  return result;
}

}  // namespace

std::string to_string(KeypointSource source) {
  switch (source) {
    case KeypointSource::detected:
      return "detected";
    case KeypointSource::derived:
      return "derived";
    case KeypointSource::user:
      return "user";
    case KeypointSource::none:
      return "none";
  }
  return "none";
}

std::string registration_json(const Registration& registration, std::string_view version, JsonStyle style) {
  ordered_json document;
  document["vitruvian"] = version;
  document["scan"] = scan_json(registration);
  document["model"] = model_json(registration.model);
  document["alignment"] = alignment_json(registration.alignment);
  document["keypoints"] = keypoint_rows(registration.keypoints);
  document["parameters"] = parameters_json(registration.parameters);
  document["joints"] = joint_rows(registration.joints);
  document["surface_error"] =
      registration.surface_error ? surface_error_json(*registration.surface_error) : ordered_json();
  if (registration.surface_error && registration.parametric_error) {
    document["surface_error"]["parametric"] = surface_error_json(*registration.parametric_error);
  }
  document["verdict"] = {{"status", to_string(registration.verdict.status)},
                         {"confidence", rounded(registration.verdict.confidence, 1e4)},
                         {"reasons", registration.verdict.reasons}};
  if (registration.verdict_features)
    document["verdict"]["features"] = features_to_json(*registration.verdict_features);
  document["timing_ms"] = timing_json(registration.timing_ms);
  document["settings"] = settings_to_json(registration.settings);
  return json_text(document, style);
}

std::string error_json(std::string_view scan, std::string_view code, std::string_view message) {
  ordered_json document;
  document["scan"] = scan;
  document["error"] = {{"code", code}, {"message", message}};
  return json_text(document, JsonStyle::compact);
}

}  // namespace vitruvian
