#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vitruvian {

/// One reading of the file's unit.
struct UnitCandidate {
  std::string unit;  ///< "m", "cm", "mm", "in"
  double metres_per_unit;
  double extent_m;    ///< the scan's diameter under this reading
  double likelihood;  ///< 0..1, for a body in an unknown posture
};

struct UnitGuess {
  std::vector<UnitCandidate> candidates;  ///< possible ones, the likeliest first; never empty
  bool ambiguous = false;  ///< a second candidate is possible: judge both by the stature of the posed fit
  std::string note;        ///< plain words; empty when there is nothing to say
};

/// Stature range of a person, standing upright, that counts as likely.
constexpr double kLeastStature = 1.35, kLargestStature = 2.10;

/// Readings of a scan's unit from its diameter alone. A standing body measures its stature, with arms raised
/// up to 1.3 times that, sitting or crouching down to 0.4: the diameter lists candidates and cannot always
/// decide, most of all between centimetres and inches (50 to 98 file units).
/// @param extent  diameter of the body's points in file units.
/// @param declared_metres_per_unit  what the file's format promises (GLB: 1); believed unless absurd.
/// @throws Error(no_geometry) when the extent is not a positive number.
UnitGuess guess_unit(double extent, std::optional<double> declared_metres_per_unit = std::nullopt);

}  // namespace vitruvian
