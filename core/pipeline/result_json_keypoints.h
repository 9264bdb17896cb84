#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/types.h"
#include "pipeline/edits.h"
#include "pipeline/result_json.h"
#include "pipeline/result_json_value.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// @throws Error(bad_file) naming the place: unknown frame or joint, position not three finite numbers,
/// confidence out of 0..1, no joint at all.
KeypointSet parse_keypoints(std::string_view text, const std::string& file_name);

/// The same of a value inside a document.
KeypointSet keypoint_set_from_json(const JsonValue& value);
nlohmann::ordered_json keypoint_set_to_json(const KeypointSet& keypoints);

/// The same of one joint: `{"position", "confidence"}`, confidence 1 when it is missing.
KeypointSet::Joint keypoint_joint_from_json(const JsonValue& value);
nlohmann::ordered_json keypoint_joint_to_json(const KeypointSet::Joint& joint);

/// Joints in SMPL order.
std::string keypoints_json(const KeypointSet& keypoints, JsonStyle style);

/// Known joints of a scan: truth JSON of contract.md, scan frame.
struct JointTruth {
  Unit unit = Unit::metre;  ///< of the scan frame
  std::map<std::string, Vec3d> joints;
};

/// Joints of other names than the 22 are kept; members besides frame, unit and joints are ignored.
/// @throws Error(bad_file) naming the place.
JointTruth parse_truth(std::string_view text, const std::string& file_name);

/// A 4x4 `body_from_scan` given as JSON (four rows of four numbers, bare or under the key "body_from_scan"):
/// a similarity without mirroring, unit factor included.
/// @throws Error(bad_file) naming what is wrong.
Mat4d parse_alignment(std::string_view text, const std::string& file_name);
/// The same of the four rows inside a document.
Mat4d alignment_from_json(const JsonValue& value);

}  // namespace vitruvian
