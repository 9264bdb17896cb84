#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "anthropometry/dimensions.h"
#include "anthropometry/measurements.h"
#include "pipeline/result_json.h"

namespace vitruvian {

/// An anatomical landmark on the registered body.
struct LandmarkReport {
  std::string name;
  Vec3d body_m, scan;
  std::optional<double>
      confidence;  ///< 0..1, see landmark_confidence(); none where nothing is known of the fit
};

/// How sure a landmark's place is: the share of its segment that was observed, times 1 at a perfect fit of
/// the segment falling to 1/2 at a mean distance of 10 mm. 0 where the segment was not observed.
double landmark_confidence(double observed, double mean_error_m);

/// Everything that measurements.json of contract.md holds.
struct MeasurementReport {
  std::string registration_sha256;
  BodyMeasures body;
  std::vector<Dimension> dimensions;
  std::vector<LandmarkReport> landmarks;
  std::vector<SectionResult> sections;
};

/// measurements.json. Beyond the contract's members: reasons, densities, frames and the uniform variant, each
/// described in docs/measurements.md. What is unknown is null.
std::string measurements_json(const MeasurementReport& report, JsonStyle style);

/// measurements.csv: a row a value, `id,name,standard,side,value,unit,uncertainty`.
std::string measurements_csv(const MeasurementReport& report);

}  // namespace vitruvian
