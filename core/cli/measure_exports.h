#pragma once

#include <string>
#include <vector>

#include "anthropometry/figure.h"
#include "cli/measure_arguments.h"
#include "measure/surface_error_compute.h"
#include "pipeline/measurements_json.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// A measured registration, as the exports need it.
struct MeasuredRegistration {
  const Registration& registration;
  const MeasurementReport& report;
  const Figure& scanned;   ///< as registered, body frame
  const Figure& standing;  ///< in the standard posture
  const BodyState& state;
  const Points3d& rest_offsets;       ///< 3 x V or empty
  const SurfaceMeasurement* surface;  ///< null without --scan
};

/// A file to write.
struct ExportedFile {
  std::string name, content;
};

/// Files of one format: glb, npz, smpl, trc, landmarks, ply, obj or html. Coloured errors only with a scan.
/// @throws Error(usage) for any other.
std::vector<ExportedFile> export_files(const std::string& format, const MeasuredRegistration& measured);

}  // namespace vitruvian
