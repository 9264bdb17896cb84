#pragma once

#include <span>
#include <string_view>

namespace vitruvian {

/// How far a dimension was from the truth on scans of strangers whose true surface is known (suite `scanner`
/// of scripts/benchmark, people standing): docs/measurements.md "How well".
struct DimensionError {
  /// Over both sides of all scans.
  struct Size {
    double rms_mm;  ///< root mean square difference
    double fit_mm;  ///< mean distance between body and scan over the segments that the dimension touches
  };
  std::string_view id;  ///< without the side; the table is sorted by it
  Size parametric;      ///< of the body model's own surface
  Size refined;         ///< with vertex offsets
};

/// Made by scripts/measurement_error.
std::span<const DimensionError> dimension_errors();

}  // namespace vitruvian
