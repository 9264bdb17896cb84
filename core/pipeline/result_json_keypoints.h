#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/types.h"
#include "pipeline/result_json.h"
#include "pipeline/settings.h"

namespace vitruvian {

enum class KeypointFrame { scan, body, canonical };

/// Joints placed by hand or exported: keypoints JSON of contract.md.
struct KeypointSet {
  struct Joint {
    Vec3d position = Vec3d::Zero();  ///< scan units in the scan frame, else metres
    double confidence = 1;           ///< 0..1
  };
  KeypointFrame frame = KeypointFrame::scan;
  std::map<std::string, Joint> joints;  ///< by SMPL name; a joint that is missing is not used
};

/// @throws Error(bad_file) naming the place: unknown frame or joint, position not three finite numbers,
/// confidence out of 0..1, no joint at all.
KeypointSet parse_keypoints(std::string_view text, const std::string& file_name);

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

}  // namespace vitruvian
