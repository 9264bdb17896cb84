#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/scan.h"
#include "pipeline/result_json_value.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// The scan lies as this says; none: as it is found.
struct AlignEdit {
  std::optional<Mat4d> body_from_scan;
};
/// Cuts a part of the scan away, beside what was cut before.
struct CropEdit {
  CutVolume volume;
};
/// Replaces all keypoints; none: those that are found.
struct KeypointsEdit {
  std::optional<KeypointSet> keypoints;
};
/// Moves, adds or (none) removes some of the keypoints. They are in the scan frame.
struct JointsEdit {
  std::map<std::string, std::optional<KeypointSet::Joint>> joints;
};
/// Replaces the pairs of regions; none: no regions.
struct RegionsEdit {
  std::optional<RegionSet> regions;
};

/// One thing that was done by hand.
struct Edit {
  std::variant<AlignEdit, CropEdit, KeypointsEdit, JointsEdit, RegionsEdit> what;
  std::string label;  ///< plain words for a list of edits; may be empty
};

/// What was done to a scan by hand, in its order, and the settings beside it: a project file. Positions are
/// in the scan frame and scan units, so that an edit stays right whatever comes before it.
struct Project {
  std::string scan_file;     ///< name without folder
  std::string scan_sha256;   ///< of the file's bytes
  std::string model_sha256;  ///< of the body model; empty: any
  Settings settings;         ///< without what the edits say
  std::vector<Edit> edits;
};

/// Reads a project file (docs/project.md).
/// @throws Error(bad_file) naming the place, also for versions that are newer than this program.
Project parse_project(std::string_view text, const std::string& file_name);

/// A list of edits by itself: the value of "edits" in a project file.
std::vector<Edit> edits_from_json(const JsonValue& array);
nlohmann::ordered_json edits_to_json(const std::vector<Edit>& edits);

/// The project file. Number of threads is not in it: it belongs to the machine.
std::string project_json(const Project& project);

/// Settings with the edits made one after the other.
/// @throws Error(usage) when an edit moves joints of keypoints that are in another frame than the scan's.
Settings with_edits(const Settings& settings, const std::vector<Edit>& edits);

/// Refuses a project that was made on another scan. @throws Error(usage).
void check_scan(const Project& project, const Scan& scan);
/// Refuses a project that was made with another body model. @throws Error(usage).
void check_model(const Project& project, const BodyModel& model);

}  // namespace vitruvian
