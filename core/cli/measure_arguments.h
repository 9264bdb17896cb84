#pragma once

#include <string>
#include <vector>

#include "anthropometry/measurements.h"

namespace CLI {
class App;
}

namespace vitruvian {

/// `--profile SEGMENT:N`.
struct ProfileRequest {
  int segment = 0;
  int count = 0;
};

/// `vitruvian measure`.
struct MeasureArguments {
  std::string registration_file;
  std::string out;         ///< empty: JSON to stdout
  std::string model_file;  ///< empty: the default body
  std::string dmpl_file;   ///< empty: none
  std::string scan_file;   ///< empty: none
  std::vector<SectionRequest> sections;
  std::vector<ProfileRequest> profiles;
  std::vector<std::string> exports;  ///< formats, see export_files()
};

/// SEGMENT:t=F, SEGMENT:d=MM or SEGMENT:d=MM@distal (also @proximal).
/// @throws Error(usage).
SectionRequest parse_section(const std::string& text);
/// SEGMENT:N, N from 2 to 10000.
/// @throws Error(usage).
ProfileRequest parse_profile(const std::string& text);

/// Adds the command's options; values go to `arguments`, which must outlive the parse.
void add_measure_options(CLI::App& command, MeasureArguments& arguments);

}  // namespace vitruvian
