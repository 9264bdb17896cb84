#include "session_json.h"

#include <cstdint>

#include "base/error.h"
#include "pipeline/settings_names.h"

namespace vitruvian::wasm {
namespace {

/// Sets `value` from the member `key`, if there is one.
template <typename Enum>
void read_choice(const nlohmann::json& json, const char* key, Enum& value) {
  if (!json.contains(key)) return;
  const std::string name = json.at(key).is_string() ? json.at(key).get<std::string>() : json.at(key).dump();
  const auto found = value_named<Enum>(name);
  if (!found) throw Error(ErrorCode::usage, "settings: " + std::string(key) + " cannot be \"" + name + "\"");
  value = *found;
}

}  // namespace

nlohmann::json array_reference(const void* data, std::ptrdiff_t elements) {
  return {reinterpret_cast<std::uintptr_t>(data), elements};
}

nlohmann::json describe_scan(const Scan& scan, const DecimatedMesh& shown) {
  return {
      {"vertices", scan.vertices.cols()},
      {"faces", scan.faces.cols()},
      {"decimated", shown.vertices.cols() < scan.vertices.cols()},
      {"origin", {scan.origin.x(), scan.origin.y(), scan.origin.z()}},
      {"notes", scan.notes},
      {"positions", array_reference(shown.vertices.data(), shown.vertices.size())},
      {"normals", array_reference(shown.normals.data(), shown.normals.size())},
      {"indices", array_reference(shown.faces.data(), shown.faces.size())},
  };
}

nlohmann::json describe_request(const NetworkRequest& request) {
  nlohmann::json inputs = nlohmann::json::array();
  for (const auto& input : request.inputs) {
    inputs.push_back(array_reference(input.data(), static_cast<std::ptrdiff_t>(input.size())));
  }
  return {{"network", request.network == Network::detector ? "detector" : "landmarks"}, {"inputs", inputs}};
}

nlohmann::json describe_views(const LandmarkStage& stage) {
  nlohmann::json views = nlohmann::json::array();
  const auto& landmarks = stage.view_landmarks();
  for (std::size_t i = 0; i < stage.views().size(); ++i) {
    const View& view = stage.views()[i];
    nlohmann::json dots = nlohmann::json::array();
    if (i < landmarks.size()) {
      for (const ViewLandmark& l : landmarks[i].landmarks) {
        dots.push_back({{"x", l.pixel.x()}, {"y", l.pixel.y()}, {"confidence", l.visibility}});
      }
    }
    views.push_back({{"width", view.camera.width},
                     {"height", view.camera.height},
                     {"rgb", array_reference(view.rgb.data(), static_cast<std::ptrdiff_t>(view.rgb.size()))},
                     {"landmarks", dots}});
  }
  return views;
}

Settings parse_settings(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) throw Error(ErrorCode::usage, "settings: an object is expected");
  Settings settings;
  read_choice(json, "method", settings.method);
  read_choice(json, "align", settings.align);
  read_choice(json, "init", settings.init);
  read_choice(json, "solver", settings.solver);
  read_choice(json, "gender", settings.gender);
  read_choice(json, "unit", settings.unit);
  read_choice(json, "up", settings.up);
  read_choice(json, "front", settings.front);
  read_choice(json, "detail", settings.detail);
  settings.views = json.value("views", settings.views);
  settings.seed = json.value("seed", settings.seed);
  return settings;
}

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace vitruvian::wasm
