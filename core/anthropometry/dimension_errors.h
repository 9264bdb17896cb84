#pragma once

#include <span>
#include <string_view>

namespace vitruvian {

/// How far a dimension was from the truth on scans of strangers whose true surface is known (suite `scanner`
/// of scripts/benchmark, people standing): docs/measurements.md "How well".
struct DimensionError {
  std::string_view id;  ///< without the side; the table is sorted by it
  double rms_mm;        ///< root mean square difference, both sides
  double fit_mm;        ///< mean distance between body and scan over the segments it touches, in those scans
};

/// Made by scripts/measurement_error.
std::span<const DimensionError> dimension_errors();

}  // namespace vitruvian
