#include "session_json.h"

#include <cstdint>

#include "base/error.h"
#include "pipeline/result_json_value.h"
#include "pipeline/settings_json.h"

namespace vitruvian::wasm {

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

nlohmann::json describe_alignment(const RegistrationPipeline::AlignFinding& finding) {
  const Alignment& alignment = finding.alignment;
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row) {
    const Eigen::RowVector4d r = alignment.body_from_scan.row(row);
    rows.push_back({r[0], r[1], r[2], r[3]});
  }
  return {{"unit", to_string(alignment.unit)},
          {"metres_per_unit", alignment.metres_per_unit},
          {"up", alignment.up},
          {"front", alignment.front},
          {"front_is_known", finding.front_is_known},
          {"method", alignment.method},
          {"body_from_scan", rows},
          {"height_m", finding.height_m},
          {"note", finding.unit_note}};
}

nlohmann::json describe_keypoints(const std::vector<Keypoint>& keypoints) {
  nlohmann::json list = nlohmann::json::array();
  for (const Keypoint& k : keypoints) {
    nlohmann::json position;
    if (k.position_m) position = {k.position_m->x(), k.position_m->y(), k.position_m->z()};
    list.push_back({{"joint", k.joint},
                    {"position_m", position},
                    {"confidence", k.confidence},
                    {"source", to_string(k.source)}});
  }
  return list;
}

nlohmann::json describe_joints(const BodyModel& body, const BodyState& state) {
  const Skeleton skeleton = pose_skeleton(body, state);
  const Points3d turns = state.axis_angle();
  nlohmann::json list = nlohmann::json::array();
  for (int j = 0; j < body.joint_count(); ++j) {
    const Vec3d at = skeleton.joints.col(j);
    list.push_back({{"name", body.joint_names[j]},
                    {"body_m", {at.x(), at.y(), at.z()}},
                    {"turn_rad", turns.col(j).norm()}});
  }
  return list;
}

Settings parse_settings(const std::string& text) {
  try {
    const nlohmann::json json = parse_json(text, "settings");
    return chosen_settings(JsonValue(json, "settings", ""));
  } catch (const Error& error) {
    throw Error(ErrorCode::usage, error.what());
  }
}

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace vitruvian::wasm
