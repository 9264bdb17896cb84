#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "anthropometry/figure.h"
#include "base/random.h"

namespace vitruvian::testing {

/// The default body that scripts/start builds; a missing file fails the test.
inline const BodyModel& made_body() {
  static const BodyModel body = [] {
    const char* folder = std::getenv("VITRUVIAN_DATA");
    const std::string path = std::string(folder ? folder : VITRUVIAN_MODELS_DIR) + "/body.vbm";
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    return read_body_model({reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()}, path);
  }();
  return body;
}

inline const MeasuredModel& measured_body() {
  static const MeasuredModel model(made_body());
  return model;
}

/// A likely shape and a moderate pose.
inline BodyState moved_state(std::uint32_t seed, double pose_scale) {
  Random random(seed);
  BodyState state = BodyState::rest(made_body());
  Points3d pose(3, made_body().joint_count());
  for (Index i = 0; i < pose.size(); ++i) pose.data()[i] = pose_scale * random.normal();
  for (Index k = 0; k < state.betas.size(); ++k) state.betas[k] = random.normal();
  return BodyState::from_axis_angle(pose, state.betas, Vec3d(0.1, 0.2, -0.3));
}

}  // namespace vitruvian::testing
