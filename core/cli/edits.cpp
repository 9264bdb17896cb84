#include "cli/edits.h"

#include "base/error.h"
#include "io/file.h"
#include "pipeline/crop.h"
#include "pipeline/regions.h"
#include "pipeline/result_json.h"
#include "pipeline/result_json_keypoints.h"

namespace vitruvian {
namespace {

std::string text_of(const std::string& path) {
  const FileBytes file(path);
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

StartBody read_start(const std::string& path) {
  Registration registration = parse_registration(text_of(path), path);
  if (!registration.parameters) {
    throw Error(ErrorCode::bad_file,
                path + ": parameters: there are none, this registration failed; start from one that did not");
  }
  // Vertex offsets lie on top of the parametric body that a fit starts from.
  registration.parameters->offsets_file.clear();
  return {std::move(*registration.parameters), registration.model.sha256};
}

void check_alone(const RegisterArguments& arguments) {
  if (!arguments.decided.empty()) {
    throw Error(ErrorCode::usage,
                "--project says already what " + arguments.decided.front() + " says: leave that out");
  }
  if (arguments.scans.size() > 1)
    throw Error(ErrorCode::usage, "--project belongs to one scan: give that alone");
}

}  // namespace

RegisterArguments load_edits(const RegisterArguments& arguments) {
  RegisterArguments loaded = arguments;
  Settings& settings = loaded.settings;
  if (!arguments.project_file.empty()) {
    check_alone(arguments);
    loaded.project = parse_project(text_of(arguments.project_file), arguments.project_file);
    settings = with_edits(loaded.project->settings, loaded.project->edits);
    settings.threads = arguments.settings.threads;
  }
  if (!arguments.crop_file.empty())
    settings.crops = parse_crops(text_of(arguments.crop_file), arguments.crop_file);
  if (!arguments.align_file.empty())
    settings.body_from_scan = parse_alignment(text_of(arguments.align_file), arguments.align_file);
  if (!arguments.keypoints_file.empty())
    settings.keypoints = parse_keypoints(text_of(arguments.keypoints_file), arguments.keypoints_file);
  if (!arguments.regions_file.empty())
    settings.regions = parse_regions(text_of(arguments.regions_file), arguments.regions_file);
  if (!arguments.init_file.empty()) {
    settings.init = InitMode::file;
    settings.start = read_start(arguments.init_file);
  }
  return loaded;
}

}  // namespace vitruvian
