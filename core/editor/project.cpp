#include "editor/project.h"

#include <algorithm>

#include "base/error.h"
#include "pipeline/crop.h"
#include "pipeline/regions.h"
#include "pipeline/result_json_keypoints.h"
#include "pipeline/settings_json.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr std::size_t kMostEdits = 1'000'000;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

JointsEdit joints_from_json(const JsonValue& value) {
  JointsEdit edit;
  value.for_each_member([&](const std::string& name, const JsonValue& joint) {
    if (std::find(kSmplJointNames.begin(), kSmplJointNames.begin() + 22, name) ==
        kSmplJointNames.begin() + 22)
      joint.fail("this is none of the 22 SMPL joints");
    std::optional<KeypointSet::Joint>& placed = edit.joints[name];
    if (!joint.is_null()) placed = keypoint_joint_from_json(joint);
  });
  if (edit.joints.empty()) value.fail("there is no joint");
  return edit;
}

Edit edit_from_json(const JsonValue& value) {
  Edit edit;
  if (value.has("label")) edit.label = value.at("label").text();
  const std::string kind = value.at("edit").text();
  if (kind == "align") {
    AlignEdit align;
    const JsonValue matrix = value.at("body_from_scan");
    if (!matrix.is_null()) align.body_from_scan = alignment_from_json(matrix);
    edit.what = align;
  } else if (kind == "crop") {
    edit.what = CropEdit{crop_from_json(value)};
  } else if (kind == "keypoints") {
    KeypointsEdit keypoints;
    const JsonValue set = value.at("keypoints");
    if (!set.is_null()) keypoints.keypoints = keypoint_set_from_json(set);
    edit.what = keypoints;
  } else if (kind == "joints") {
    edit.what = joints_from_json(value.at("joints"));
  } else if (kind == "regions") {
    RegionsEdit regions;
    const JsonValue set = value.at("regions");
    if (!set.is_null()) regions.regions = regions_from_json(set);
    edit.what = regions;
  } else {
    value.at("edit").fail("one of align crop keypoints joints regions is expected");
  }
  return edit;
}

ordered_json edit_to_json(const Edit& edit) {
  ordered_json result;
  const auto begin = [&](const char* kind) {
    result["edit"] = kind;
    if (!edit.label.empty()) result["label"] = edit.label;
  };
  std::visit(Overloaded{[&](const AlignEdit& align) {
                          begin("align");
                          result["body_from_scan"] = nullptr;
                          if (align.body_from_scan) result["body_from_scan"] = rows(*align.body_from_scan);
                        },
                        [&](const CropEdit& crop) {
                          begin("crop");
                          result.update(crop_to_json(crop.volume));
                        },
                        [&](const KeypointsEdit& keypoints) {
                          begin("keypoints");
                          result["keypoints"] = nullptr;
                          if (keypoints.keypoints)
                            result["keypoints"] = keypoint_set_to_json(*keypoints.keypoints);
                        },
                        [&](const JointsEdit& joints) {
                          begin("joints");
                          for (const auto& [name, joint] : joints.joints) {
                            result["joints"][name] = nullptr;
                            if (joint) result["joints"][name] = keypoint_joint_to_json(*joint);
                          }
                        },
                        [&](const RegionsEdit& regions) {
                          begin("regions");
                          result["regions"] = nullptr;
                          if (regions.regions) result["regions"] = regions_to_json(*regions.regions);
                        }},
             edit.what);
  return result;
}

void apply(const JointsEdit& edit, Settings& settings) {
  if (!settings.keypoints) settings.keypoints = KeypointSet{};
  if (settings.keypoints->frame != KeypointFrame::scan) {
    throw Error(ErrorCode::usage,
                "project: joints are moved in the scan frame, but the keypoints before are in another one");
  }
  for (const auto& [name, joint] : edit.joints) {
    if (joint) {
      settings.keypoints->joints[name] = *joint;
    } else {
      settings.keypoints->joints.erase(name);
    }
  }
}

}  // namespace

std::vector<Edit> edits_from_json(const JsonValue& array) {
  if (array.size() > kMostEdits) array.fail("there are too many edits");
  std::vector<Edit> edits;
  for (std::size_t i = 0; i < array.size(); ++i) edits.push_back(edit_from_json(array.at(i)));
  return edits;
}

ordered_json edits_to_json(const std::vector<Edit>& edits) {
  ordered_json result = ordered_json::array();
  for (const Edit& edit : edits) result.push_back(edit_to_json(edit));
  return result;
}

Project parse_project(std::string_view text, const std::string& file_name) {
  const nlohmann::json json = parse_json(text, file_name);
  const JsonValue document(json, file_name, "");
  const JsonValue version = document.at("vitruvian_project");
  if (version.whole(1, 1'000'000) > kVersion)
    version.fail("this program reads version " + std::to_string(kVersion) + ": use a newer one");
  Project project;
  project.scan_file = document.at("scan").at("file").text();
  project.scan_sha256 = document.at("scan").at("sha256").text();
  if (document.has("model")) project.model_sha256 = document.at("model").at("sha256").text();
  project.settings = settings_from_json(document.at("settings"));
  project.settings.threads = 0;
  project.edits = edits_from_json(document.at("edits"));
  return project;
}

std::string project_json(const Project& project) {
  ordered_json document;
  document["vitruvian_project"] = kVersion;
  document["scan"]["file"] = project.scan_file;
  document["scan"]["sha256"] = project.scan_sha256;
  if (!project.model_sha256.empty()) document["model"]["sha256"] = project.model_sha256;
  Settings settings = project.settings;
  settings.threads = 0;
  document["settings"] = settings_to_json(settings);
  document["edits"] = edits_to_json(project.edits);
  return json_text(document, JsonStyle::pretty);
}

Settings with_edits(const Settings& settings, const std::vector<Edit>& edits) {
  Settings result = settings;
  for (const Edit& edit : edits) {
    std::visit(Overloaded{[&](const AlignEdit& align) { result.body_from_scan = align.body_from_scan; },
                          [&](const CropEdit& crop) { result.crops.push_back(crop.volume); },
                          [&](const KeypointsEdit& keypoints) { result.keypoints = keypoints.keypoints; },
                          [&](const JointsEdit& joints) { apply(joints, result); },
                          [&](const RegionsEdit& regions) { result.regions = regions.regions; }},
               edit.what);
  }
  if (result.keypoints && result.keypoints->joints.empty()) result.keypoints.reset();
  return result;
}

void check_scan(const Project& project, const Scan& scan) {
  if (scan.sha256 == project.scan_sha256) return;
  throw Error(ErrorCode::usage, "--project: it was made on another scan (" + project.scan_file + ") than " +
                                    scan.file_name + ": their sha256 differ; give the scan it belongs to");
}

void check_model(const Project& project, const BodyModel& model) {
  if (project.model_sha256.empty() || model.sha256 == project.model_sha256) return;
  throw Error(ErrorCode::usage, "--project: it was made with another body model than " + model.name +
                                    " (their sha256 differ); give that model with --model");
}

}  // namespace vitruvian
