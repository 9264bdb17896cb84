#pragma once

#include <array>
#include <string_view>

namespace vitruvian {

/// Where an anatomical landmark lies on the default body's rest pose (T-pose, palms down), metres.
struct LandmarkPlace {
  std::string_view name;
  std::array<double, 3> position;
};

/// All landmarks, named as in the CAESAR survey (and a few more that ISO 7250-1 and ISO 8559-1 measure from).
extern const std::array<LandmarkPlace, 87> kLandmarkTable;
/// The default body's 24 joints in the same pose.
extern const std::array<std::array<double, 3>, 24> kLandmarkJoints;

}  // namespace vitruvian
