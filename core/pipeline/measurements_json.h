#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "anthropometry/measurements.h"
#include "pipeline/result_json.h"

namespace vitruvian {

/// Everything that measurements.json of contract.md holds.
struct MeasurementReport {
  std::string registration_sha256;
  BodyMeasures body;
  std::vector<SectionResult> sections;
};

/// measurements.json. Beyond the contract's members: reasons, densities, frames and the uniform variant, each
/// described in docs/measurements.md. What is unknown is null.
std::string measurements_json(const MeasurementReport& report, JsonStyle style);

/// measurements.csv: a row a value, `id,name,standard,side,value,unit,uncertainty`.
std::string measurements_csv(const MeasurementReport& report);

}  // namespace vitruvian
