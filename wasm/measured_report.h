#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measured/export_files.h"

namespace vitruvian::wasm {

/// measurements.json with, for each dimension, "kind" (tape, line, height, extent) and "course": its corners
/// in the scan's frame and units.
nlohmann::json describe_measurements(const MeasuredRegistration& measured);

/// `[{...as in measurements.json's sections, "course"}]`. @throws Error(usage) when there is no such segment.
nlohmann::json describe_profile(const MeasuredRegistration& measured, const std::string& segment, int count);

/// What `vitruvian measure` writes: measurements.json and .csv for "measurements", the files of an export
/// format, or all of it for "all". @throws Error(usage).
std::vector<ExportedFile> measured_files(const MeasuredRegistration& measured, const std::string& format);

}  // namespace vitruvian::wasm
