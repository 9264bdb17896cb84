#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cli/measure_arguments.h"
#include "editor/project.h"
#include "pipeline/settings.h"

namespace vitruvian {

enum class MeshFormat { ply, obj, glb };
/// File name of the registered mesh, e.g. "registered.ply".
std::string registered_mesh_name(MeshFormat format);

/// `vitruvian register`.
struct RegisterArguments {
  std::vector<std::string> scans;
  std::string out;
  Settings settings;
  std::string model_file;  ///< empty: the default body
  std::string init_file;   ///< --init FILE; this and the following are empty when not given
  std::string align_file;
  std::string keypoints_file;
  std::string regions_file;
  std::string crop_file;
  std::string project_file;
  /// Options that were given and decide a registration: a project says all of them itself.
  std::vector<std::string> decided;
  std::optional<Project> project;  ///< of --project, once it is read
  std::string dmpl_file;           ///< empty: no soft tissue
  std::string prior_file;          ///< empty: the bundled pose prior
  MeshFormat format = MeshFormat::ply;
  bool quiet = false;
  bool json = false;
};

/// `vitruvian evaluate`.
struct EvaluateArguments {
  std::string registration_file;
  std::string truth_file;
};

/// `vitruvian model info`.
struct ModelInfoArguments {
  std::string file;
};

/// A text the user asked for: help or version.
struct PrintArguments {
  std::string text;
};

using Arguments =
    std::variant<PrintArguments, RegisterArguments, MeasureArguments, EvaluateArguments, ModelInfoArguments>;

/// Parses the command line (contract.md "CLI").
/// @param arguments  without the program's name.
/// @throws Error(usage) saying which option is wrong and how to get help.
Arguments parse_arguments(const std::vector<std::string>& arguments);

}  // namespace vitruvian
