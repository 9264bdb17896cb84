#include "pipeline/settings_json.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "pipeline/crop.h"
#include "pipeline/regions.h"
#include "pipeline/result_json_keypoints.h"
#include "pipeline/settings_names.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t kLargestCount = 1'000'000;

void add_edits(ordered_json& result, const Settings& settings) {
  if (settings.body_from_scan) result["body_from_scan"] = rows(*settings.body_from_scan);
  if (!settings.crops.empty()) result["crops"] = crops_to_json(settings.crops);
  if (settings.keypoints) result["keypoints"] = keypoint_set_to_json(*settings.keypoints);
  if (settings.regions) result["regions"] = regions_to_json(*settings.regions);
  if (settings.start) {
    result["start"] = parameters_to_json(settings.start->parameters);
    result["start"]["model_sha256"] = settings.start->model_sha256;
  }
}

bool given(const JsonValue& value, const char* key) { return value.has(key) && !value.at(key).is_null(); }

/// Reads one setting.
struct SettingReader {
  const char* name;
  void (*read)(const JsonValue& value, Settings& settings);
};

template <auto member>
void read_choice(const JsonValue& value, Settings& settings) {
  settings.*member = named<std::remove_reference_t<decltype(settings.*member)>>(value);
}

template <auto member, std::int64_t low, std::int64_t high>
void read_whole(const JsonValue& value, Settings& settings) {
  settings.*member = static_cast<std::remove_reference_t<decltype(settings.*member)>>(value.whole(low, high));
}

/// Every setting but the edits, by its name.
constexpr SettingReader kReaders[] = {
    {"method", read_choice<&Settings::method>},
    {"align", read_choice<&Settings::align>},
    {"views", read_whole<&Settings::views, 1, 64>},
    {"min_visibility",
     [](const JsonValue& value, Settings& settings) { settings.min_visibility = value.number(); }},
    {"init", read_choice<&Settings::init>},
    {"solver", read_choice<&Settings::solver>},
    {"iterations", read_whole<&Settings::iterations, 1, kLargestCount>},
    {"adam_iterations", read_whole<&Settings::adam_iterations, 0, kLargestCount>},
    {"one_directional",
     [](const JsonValue& value, Settings& settings) { settings.one_directional = value.truth(); }},
    {"chunk", read_whole<&Settings::chunk, 0, kLargestCount>},
    {"gender", read_choice<&Settings::gender>},
    {"betas", read_whole<&Settings::betas, 0, 10000>},
    {"units", read_choice<&Settings::unit>},
    {"up", read_choice<&Settings::up>},
    {"front", read_choice<&Settings::front>},
    {"detail", read_choice<&Settings::detail>},
    {"threads", read_whole<&Settings::threads, 0, 4096>},
    {"seed", read_whole<&Settings::seed, 0, std::numeric_limits<std::uint32_t>::max()>},
};
constexpr std::array<std::string_view, 5> kEdits = {"body_from_scan", "crops", "keypoints", "regions",
                                                    "start"};

void read_edits(const JsonValue& value, Settings& settings) {
  if (given(value, "body_from_scan"))
    settings.body_from_scan = alignment_from_json(value.at("body_from_scan"));
  if (given(value, "crops")) settings.crops = crops_from_json(value.at("crops"));
  if (given(value, "keypoints")) settings.keypoints = keypoint_set_from_json(value.at("keypoints"));
  if (given(value, "regions")) settings.regions = regions_from_json(value.at("regions"));
  if (given(value, "start")) {
    const JsonValue start = value.at("start");
    settings.start = StartBody{parameters_from_json(start), start.at("model_sha256").text()};
    // Vertex offsets lie on top of the parametric body that a fit starts from.
    settings.start->parameters.offsets_file.clear();
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
  if (given(value, "method")) settings = settings_of(named<Method>(value.at("method")));
  for (const auto& [name, read] : kReaders) {
    if (given(value, name)) read(value.at(name), settings);
  }
  read_edits(value, settings);
  return settings;
}

Settings chosen_settings(const JsonValue& value) {
  value.for_each_member([](const std::string& name, const JsonValue& member) {
    const auto is_its = [&](const SettingReader& reader) { return reader.name == name; };
    if (std::none_of(std::begin(kReaders), std::end(kReaders), is_its) &&
        std::find(kEdits.begin(), kEdits.end(), name) == kEdits.end())
      member.fail("there is no setting of this name");
  });
  return settings_from_json(value);
}

}  // namespace vitruvian
