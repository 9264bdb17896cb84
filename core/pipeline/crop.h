#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/cut_volume.h"
#include "io/scan.h"
#include "pipeline/result_json_value.h"

namespace vitruvian {

/// Reads a crop JSON: `{"crops": [...]}`, each as crop_from_json() reads it.
/// @throws Error(bad_file) naming the place.
std::vector<CutVolume> parse_crops(std::string_view text, const std::string& file_name);
std::vector<CutVolume> crops_from_json(const JsonValue& array);
nlohmann::ordered_json crops_to_json(const std::vector<CutVolume>& crops);

/// `{"remove": "inside"|"outside"}` with either `"box": {"min": [x,y,z], "max": [x,y,z]}` (scan frame),
/// `"box_from_scan": 4x4` (takes the box to the cube from -1 to 1), or `"clip_from_scan": 4x4` and
/// `"polygon": [[x,y], ...]` (a closed line on a picture of the scan).
CutVolume crop_from_json(const JsonValue& value);
nlohmann::ordered_json crop_to_json(const CutVolume& crop);

/// A scan without what was cut away, and where its vertices are in the file.
struct CroppedScan {
  std::shared_ptr<const Scan> scan;
  std::vector<int> kept;  ///< index in the file of each vertex; empty: all, in order
};

/// @throws Error(usage) when fewer than four vertices are left.
CroppedScan crop_scan(const std::shared_ptr<const Scan>& scan, const std::vector<CutVolume>& crops);

}  // namespace vitruvian
