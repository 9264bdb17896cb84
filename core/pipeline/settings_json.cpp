#include "pipeline/settings_json.h"

#include <limits>

#include "pipeline/regions.h"
#include "pipeline/result_json_keypoints.h"
#include "pipeline/settings_names.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t kLargestCount = 1'000'000;

void add_edits(ordered_json& result, const Settings& settings) {
  if (settings.body_from_scan) result["body_from_scan"] = rows(*settings.body_from_scan);
  if (settings.keypoints) result["keypoints"] = keypoint_set_to_json(*settings.keypoints);
  if (settings.regions) result["regions"] = regions_to_json(*settings.regions);
  if (settings.start) {
    result["start"] = parameters_to_json(settings.start->parameters);
    result["start"]["model_sha256"] = settings.start->model_sha256;
  }
}

void read_edits(const JsonValue& value, Settings& settings) {
  if (value.has("body_from_scan")) settings.body_from_scan = alignment_from_json(value.at("body_from_scan"));
  if (value.has("keypoints")) settings.keypoints = keypoint_set_from_json(value.at("keypoints"));
  if (value.has("regions")) settings.regions = regions_from_json(value.at("regions"));
  if (value.has("start")) {
    const JsonValue start = value.at("start");
    settings.start = StartBody{parameters_from_json(start), start.at("model_sha256").text()};
  }
  if ((settings.init == InitMode::file) != settings.start.has_value()) {
    value.fail("\"start\" belongs to \"init\": \"file\", and only to that");
  }
}

}  // namespace

ordered_json parameters_to_json(const BodyParameters& parameters) {
  ordered_json result;
  result["betas"] = numbers(parameters.betas);
  result["pose"] = numbers(parameters.pose);
  result["translation_m"] = numbers(parameters.translation_m);
  if (parameters.expression.size() > 0) result["expression"] = numbers(parameters.expression);
  if (parameters.dmpl.size() > 0) result["dmpl"] = numbers(parameters.dmpl);
  if (!parameters.offsets_file.empty()) result["offsets"] = parameters.offsets_file;
  return result;
}

BodyParameters parameters_from_json(const JsonValue& value) {
  BodyParameters parameters;
  parameters.betas = value.at("betas").numbers();
  const Eigen::VectorXd pose = value.at("pose").numbers();
  if (pose.size() == 0 || pose.size() % 3 != 0) value.at("pose").fail("three numbers a joint are expected");
  parameters.pose = Eigen::Map<const Points3d>(pose.data(), 3, pose.size() / 3);
  parameters.translation_m = value.at("translation_m").vector3();
  if (value.has("expression")) parameters.expression = value.at("expression").numbers();
  if (value.has("dmpl")) parameters.dmpl = value.at("dmpl").numbers();
  if (value.has("offsets")) parameters.offsets_file = value.at("offsets").text();
  return parameters;
}

ordered_json settings_to_json(const Settings& settings) {
  ordered_json result;
  result["method"] = to_string(settings.method);
  result["align"] = to_string(settings.align);
  result["views"] = settings.views;
  result["min_visibility"] = settings.min_visibility;
  result["init"] = to_string(settings.init);
  result["solver"] = to_string(settings.solver);
  result["iterations"] = settings.iterations;
  result["adam_iterations"] = settings.adam_iterations;
  result["one_directional"] = settings.one_directional;
  result["chunk"] = settings.chunk;
  result["gender"] = name_of(settings.gender);
  result["betas"] = settings.betas;
  result["units"] = to_string(settings.unit);
  result["up"] = to_string(settings.up);
  result["front"] = to_string(settings.front);
  result["detail"] = to_string(settings.detail);
  result["threads"] = settings.threads;
  result["seed"] = settings.seed;
  add_edits(result, settings);
  return result;
}

Settings settings_from_json(const JsonValue& value) {
  Settings settings;
  settings.method = named<Method>(value.at("method"));
  settings.align = named<AlignMode>(value.at("align"));
  settings.views = static_cast<int>(value.at("views").whole(1, 64));
  settings.min_visibility = value.at("min_visibility").number();
  settings.init = named<InitMode>(value.at("init"));
  settings.solver = named<SolverKind>(value.at("solver"));
  settings.iterations = static_cast<int>(value.at("iterations").whole(1, kLargestCount));
  settings.adam_iterations = static_cast<int>(value.at("adam_iterations").whole(0, kLargestCount));
  settings.one_directional = value.at("one_directional").truth();
  settings.chunk = static_cast<int>(value.at("chunk").whole(0, kLargestCount));
  settings.gender = named<Gender>(value.at("gender"));
  settings.betas = static_cast<int>(value.at("betas").whole(0, 10000));
  settings.unit = named<Unit>(value.at("units"));
  settings.up = named<Axis>(value.at("up"));
  settings.front = named<Axis>(value.at("front"));
  settings.detail = named<DetailMode>(value.at("detail"));
  settings.threads = static_cast<int>(value.at("threads").whole(0, 4096));
  settings.seed =
      static_cast<std::uint32_t>(value.at("seed").whole(0, std::numeric_limits<std::uint32_t>::max()));
  read_edits(value, settings);
  return settings;
}

}  // namespace vitruvian
