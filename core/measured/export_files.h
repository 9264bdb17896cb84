#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "measured/measured_registration.h"

namespace vitruvian {

/// A file to write.
struct ExportedFile {
  std::string name, content;
};

/// Formats that export_files() knows, in the order in which they are shown.
std::span<const std::string_view> export_formats();

/// Files of one format: html, glb, npz, smpl, trc, landmarks, ply or obj. Coloured errors only with a scan.
/// @throws Error(usage) for any other.
std::vector<ExportedFile> export_files(std::string_view format, const MeasuredRegistration& measured);

}  // namespace vitruvian
