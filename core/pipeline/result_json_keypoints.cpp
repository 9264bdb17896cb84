#include "pipeline/result_json_keypoints.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "body/model.h"
#include "pipeline/result_json_value.h"
#include "pipeline/settings_names.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kKeypointJoints = 22;
constexpr std::array<std::string_view, 3> kFrameNames = {"scan", "body", "canonical"};

bool is_keypoint_joint(std::string_view name) {
  const auto end = kSmplJointNames.begin() + kKeypointJoints;
  return std::find(kSmplJointNames.begin(), end, name) != end;
}

}  // namespace

KeypointSet parse_keypoints(std::string_view text, const std::string& file_name) {
  const nlohmann::json json = parse_json(text, file_name);
  return keypoint_set_from_json(JsonValue(json, file_name, ""));
}

KeypointSet::Joint keypoint_joint_from_json(const JsonValue& value) {
  KeypointSet::Joint joint;
  joint.position = value.at("position").vector3();
  if (value.has("confidence")) {
    joint.confidence = value.at("confidence").number();
    if (joint.confidence < 0 || joint.confidence > 1) value.at("confidence").fail("0 to 1 is expected");
  }
  return joint;
}

ordered_json keypoint_joint_to_json(const KeypointSet::Joint& joint) {
  const Vec3d& p = joint.position;
  return {{"position", {p.x(), p.y(), p.z()}}, {"confidence", joint.confidence}};
}

KeypointSet keypoint_set_from_json(const JsonValue& document) {
  KeypointSet keypoints;
  const std::string frame = document.at("frame").text();
  const auto found = std::find(kFrameNames.begin(), kFrameNames.end(), frame);
  if (found == kFrameNames.end()) document.at("frame").fail("one of scan body canonical is expected");
  keypoints.frame = static_cast<KeypointFrame>(found - kFrameNames.begin());
  document.at("joints").for_each_member([&](const std::string& name, const JsonValue& value) {
    if (!is_keypoint_joint(name)) value.fail("this is none of the 22 SMPL joints");
    keypoints.joints.emplace(name, keypoint_joint_from_json(value));
  });
  if (keypoints.joints.empty()) document.at("joints").fail("there is no joint");
  return keypoints;
}

ordered_json keypoint_set_to_json(const KeypointSet& keypoints) {
  ordered_json joints = ordered_json::object();
  for (std::size_t j = 0; j < kKeypointJoints; ++j) {
    const auto found = keypoints.joints.find(std::string(kSmplJointNames[j]));
    if (found == keypoints.joints.end()) continue;
    joints[found->first] = keypoint_joint_to_json(found->second);
  }
  ordered_json document;
  document["frame"] = kFrameNames[static_cast<std::size_t>(keypoints.frame)];
  document["joints"] = std::move(joints);
  return document;
}

std::string keypoints_json(const KeypointSet& keypoints, JsonStyle style) {
  return json_text(keypoint_set_to_json(keypoints), style);
}

JointTruth parse_truth(std::string_view text, const std::string& file_name) {
  const nlohmann::json json = parse_json(text, file_name);
  const JsonValue document(json, file_name, "");
  if (document.at("frame").text() != "scan") document.at("frame").fail("\"scan\" is expected");
  JointTruth truth;
  const std::optional<Unit> unit = value_named<Unit>(document.at("unit").text());
  if (!unit || *unit == Unit::automatic) document.at("unit").fail("one of m cm mm in is expected");
  truth.unit = *unit;
  document.at("joints").for_each_member(
      [&](const std::string& name, const JsonValue& value) { truth.joints.emplace(name, value.vector3()); });
  return truth;
}

Mat4d parse_alignment(std::string_view text, const std::string& file_name) {
  const nlohmann::json json = parse_json(text, file_name);
  const JsonValue document(json, file_name, "");
  return alignment_from_json(document.is_array() ? document : document.at("body_from_scan"));
}

Mat4d alignment_from_json(const JsonValue& value) {
  const Mat4d matrix = value.matrix4();
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) value.fail("the last row must be 0 0 0 1");
  const Mat3d linear = matrix.topLeftCorner<3, 3>();
  const double scale = std::cbrt(linear.determinant());
  if (!(scale > 0)) value.fail("the matrix mirrors or flattens the scan: its determinant must be positive");
  if (!(linear.transpose() * linear).isApprox(scale * scale * Mat3d::Identity(), 1e-4)) {
    value.fail("the upper left 3x3 must be a rotation times the metres per unit");
  }
  return matrix;
}

}  // namespace vitruvian
