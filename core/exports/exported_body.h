#pragma once

#include <string>
#include <vector>

#include "body/forward.h"

namespace vitruvian {

/// A point with a name, as marker files want it.
struct NamedPoint {
  std::string name;
  Vec3d position;
};

/// A registered body to write in other programs' formats. Refers to the model.
struct ExportedBody {
  const BodyModel& model;
  BodyState state;  ///< body frame, metres
  Gender gender = Gender::neutral;
  Mat4d body_from_scan = Mat4d::Identity();  ///< unit factor included
  std::vector<NamedPoint> landmarks;         ///< body frame, metres
  double stature_m = 0;
  double mass_kg = 0;
  Points3d rest_offsets = Points3d(3, 0);  ///< added to the shaped vertices before posing; or empty
};

}  // namespace vitruvian
