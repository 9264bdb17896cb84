#include "editor.h"

#include <Eigen/LU>
#include <cmath>
#include <set>
#include <string>

#include "base/error.h"
#include "editor/found_joints.h"
#include "editor/joint_edits.h"
#include "editor/line_of_sight.h"
#include "editor/project.h"
#include "pipeline/crop.h"
#include "pipeline/given_keypoints.h"
#include "pipeline/result_json_keypoints.h"
#include "pipeline/settings_json.h"
#include "pipeline/start_state.h"
#include "session_json.h"

namespace vitruvian::wasm {
namespace {

using nlohmann::json;

/// Steps of the preview for one movement of the pointer.
constexpr int kStepsAtOnce = 4;

JsonValue value_of(const json& request) { return {request, "editor", ""}; }

double scale_of(const Mat4d& similarity) { return std::cbrt(similarity.topLeftCorner<3, 3>().determinant()); }

json point(const Vec3d& p) { return {p.x(), p.y(), p.z()}; }

std::set<std::string> names(const json& request, const char* key) {
  std::set<std::string> result;
  if (!request.contains(key)) return result;
  const JsonValue list = value_of(request).at(key);
  for (std::size_t i = 0; i < list.size(); ++i) result.insert(list.at(i).text());
  return result;
}

json changes_to_json(const JointChanges& changes) {
  json joints = json::object();
  for (const auto& [name, joint] : changes) {
    joints[name] = nullptr;
    if (joint) joints[name] = {{"position", point(joint->position)}, {"confidence", joint->confidence}};
  }
  return {{"joints", joints}};
}

json sides(const json& request) {
  const KeypointSet keypoints = keypoint_set_from_json(value_of(request).at("keypoints"));
  const std::set<std::string> locked = names(request, "locked");
  if (!request.contains("from")) return changes_to_json(swapped_sides(keypoints, locked));
  const BodySide from = value_of(request).at("from").text() == "left" ? BodySide::left : BodySide::right;
  return changes_to_json(mirrored_limbs(keypoints, from, locked));
}

/// The found keypoints, in the scan frame, as they are to be edited.
json found_keypoints(const json& request, const EditorContext& context) {
  if (!context.pipeline) throw Error(ErrorCode::internal, "no keypoints have been looked for");
  const Mat4d scan_from_body = alignment_from_json(value_of(request).at("body_from_scan")).inverse();
  KeypointSet set;
  for (const Keypoint& keypoint :
       joints_of_model(context.pipeline->fit_model(), context.pipeline->targets())) {
    if (!keypoint.position_m) continue;
    set.joints[keypoint.joint] = {transformed(scan_from_body, *keypoint.position_m), keypoint.confidence};
  }
  return {{"keypoints", keypoint_set_to_json(set)}};
}

/// Keypoints of any frame in the scan's.
json import_keypoints(const json& request) {
  KeypointSet given =
      parse_keypoints(value_of(request).at("text").text(), value_of(request).at("name").text());
  if (given.frame != KeypointFrame::scan) {
    const Mat4d scan_from_body = alignment_from_json(value_of(request).at("body_from_scan")).inverse();
    for (const Keypoint& keypoint : keypoints_in_body(given, Mat4d::Identity())) {
      if (keypoint.position_m)
        given.joints[keypoint.joint].position = transformed(scan_from_body, *keypoint.position_m);
    }
    given.frame = KeypointFrame::scan;
  }
  return {{"keypoints", keypoint_set_to_json(given)}};
}

Settings without_edits(Settings settings) {
  settings.body_from_scan.reset();
  settings.keypoints.reset();
  settings.regions.reset();
  settings.crops.clear();
  return settings;
}

json save_project(const json& request, const EditorContext& context) {
  Project project;
  project.scan_file = context.scan.file_name;
  project.scan_sha256 = context.scan.sha256;
  project.model_sha256 = context.models.body.sha256;
  project.settings = without_edits(context.settings);
  project.edits = edits_from_json(value_of(request).at("edits"));
  // What cannot be replayed is not saved.
  with_edits(project.settings, project.edits);
  return {{"text", project_json(project)}};
}

json open_project(const json& request, const EditorContext& context) {
  const Project project =
      parse_project(value_of(request).at("text").text(), value_of(request).at("name").text());
  check_scan(project, context.scan);
  check_model(project, context.models.body);
  Settings settings = with_edits(project.settings, project.edits);
  settings.threads = context.settings.threads;
  return {{"settings", settings_to_json(project.settings)}, {"edits", edits_to_json(project.edits)}};
}

}  // namespace

json Editor::preview(const json& request, const EditorContext& context) {
  const Mat4d body_from_scan = alignment_from_json(value_of(request).at("body_from_scan"));
  KeypointSet keypoints;
  if (!request.at("keypoints").at("joints").empty())
    keypoints = keypoint_set_from_json(value_of(request).at("keypoints"));
  json answer = {{"moved", nullptr}};
  if (request.contains("sight")) {
    const JsonValue sight = value_of(request).at("sight");
    const std::string joint = sight.at("joint").text();
    const LineOfSight line{sight.at("origin").vector3() - context.scan.origin,
                           sight.at("direction").vector3()};
    const Vec3d now = keypoints.joints[joint].position - context.scan.origin;
    const double distance = (now - line.origin).dot(line.direction.normalized());
    if (const auto middle = middle_of_body(context.shown.vertices, context.shown.faces, line, distance,
                                           scale_of(body_from_scan))) {
      keypoints.joints[joint].position = *middle + context.scan.origin;
      answer["moved"] = point(keypoints.joints[joint].position);
    }
  }
  const std::vector<LandmarkTarget> targets = joint_targets(keypoints_in_body(keypoints, body_from_scan));
  if (!preview_) {
    preview_ = std::make_unique<PosePreview>(context.models, context.settings.gender, context.settings.betas);
    preview_->begin(targets);
  } else if (request.value("anew", false)) {
    preview_->begin(targets);
  }
  preview_->follow(targets, kStepsAtOnce);
  body_ = posed_vertices<float>(context.models.body, preview_->state());
  const Faces& faces = context.models.body.faces;
  answer["joints"] = describe_joints(context.models.body, preview_->state());
  answer["error_mm"] = 1000 * preview_->error(targets);
  answer["body"] = array_reference(body_.data(), body_.size());
  answer["faces"] = array_reference(faces.data(), faces.size());
  return answer;
}

json Editor::cut(const json& request, const EditorContext& context) {
  const std::vector<CutVolume> crops = crops_from_json(value_of(request).at("crops"));
  const std::vector<std::uint8_t> kept = uncut_points(crops, context.shown.vertices, context.scan.origin);
  std::vector<int> left;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) left.push_back(static_cast<int>(i));
  }
  rest_.faces = uncut_faces(context.shown.faces, kept);
  rest_.vertices.resize(3, static_cast<Index>(left.size()));
  rest_.normals.resize(3, static_cast<Index>(left.size()));
  for (std::size_t i = 0; i < left.size(); ++i) {
    rest_.vertices.col(static_cast<Index>(i)) = context.shown.vertices.col(left[i]);
    rest_.normals.col(static_cast<Index>(i)) = context.shown.normals.col(left[i]);
  }
  if (value_of(request).has("most_vertices")) {
    const int most = static_cast<int>(value_of(request).at("most_vertices").whole(100, 1'000'000));
    if (rest_.vertices.cols() > most)
      rest_ = cluster_decimate(rest_.vertices, rest_.normals, rest_.faces, most);
  }
  return {{"positions", array_reference(rest_.vertices.data(), rest_.vertices.size())},
          {"normals", array_reference(rest_.normals.data(), rest_.normals.size())},
          {"indices", array_reference(rest_.faces.data(), rest_.faces.size())}};
}

json Editor::answer(const json& request, const EditorContext& context) {
  const std::string what = value_of(request).at("do").text();
  if (what == "preview") return preview(request, context);
  if (what == "cut") return cut(request, context);
  if (what == "sides") return sides(request);
  if (what == "found_keypoints") return found_keypoints(request, context);
  if (what == "import_keypoints") return import_keypoints(request);
  if (what == "save_project") return save_project(request, context);
  if (what == "open_project") return open_project(request, context);
  throw Error(ErrorCode::internal, "the editor does not know \"" + what + "\"");
}

}  // namespace vitruvian::wasm
