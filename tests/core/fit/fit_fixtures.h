#pragma once

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/random.h"
#include "core/pose/pose_fixtures.h"
#include "fit/fit_model.h"
#include "fit/normal_equations.h"
#include "fit/scan_target.h"

namespace vitruvian::testing {

/// The default body that scripts/start builds; a missing file fails the test.
inline const BodyModel& default_body() {
  static const BodyModel body = [] {
    const char* folder = std::getenv("VITRUVIAN_DATA");
    const std::string path = std::string(folder ? folder : VITRUVIAN_MODELS_DIR) + "/body.vbm";
    return read_body_model(file_bytes(path), path);
  }();
  return body;
}

inline const FitModel& default_fit_model() {
  static const FitModel model(default_body(), shipped_prior(), Gender::neutral, 0);
  return model;
}

/// Where the shipped calibration says that a posed body's landmarks lie: what perfect eyes would see.
inline std::vector<LandmarkTarget> exact_landmarks(const BodyModel& body, const BodyState& state) {
  std::ifstream file(VITRUVIAN_SOURCE_DIR "/models/landmarks.json");
  const nlohmann::json json = nlohmann::json::parse(file);
  const Skeleton skeleton = pose_skeleton(body, state);
  std::vector<LandmarkTarget> landmarks;
  for (const nlohmann::json& entry : json.at("landmarks")) {
    const auto& offset = entry.at("offset_m");
    LandmarkTarget landmark{entry.at("landmark"),    entry.at("joint"),
                            entry.at("frame_joint"), Vec3d(offset[0], offset[1], offset[2]),
                            Vec3d::Zero(),           entry.at("weight")};
    landmark.target = landmark_position(skeleton, landmark);
    landmarks.push_back(landmark);
  }
  return landmarks;
}

/// Motion-capture poses that the prior does not know: 3 x 24 axis-angle each, root first.
inline const std::vector<Points3d>& mocap_poses() {
  static const std::vector<Points3d> poses = [] {
    std::ifstream file(VITRUVIAN_SOURCE_DIR "/tests/data/test_poses.csv");
    std::vector<Points3d> rows;
    for (std::string line; std::getline(file, line);) {
      Points3d pose(3, 24);
      std::istringstream fields(line);
      std::string field;
      Index read = 0;
      while (read < 72 && std::getline(fields, field, ',')) pose.data()[read++] = std::stod(field);
      if (read != 72) throw std::runtime_error("tests/data/test_poses.csv: a row without 72 numbers");
      rows.push_back(pose);
    }
    if (rows.size() < 60) throw std::runtime_error("tests/data/test_poses.csv: 60 rows or more expected");
    return rows;
  }();
  return poses;
}

/// One of mocap_poses() with a random shape and place.
inline BodyState test_state(int pose, std::uint32_t seed) {
  Random random(seed);
  Eigen::VectorXd betas(default_body().beta_count());
  for (Index k = 0; k < betas.size(); ++k) betas[k] = 0.9 * random.normal();
  return BodyState::from_axis_angle(mocap_poses()[pose], betas,
                                    Vec3d(random.normal(), random.normal(), random.normal()));
}

/// The surface of a posed body as a scan of `count` points, none of them a vertex.
inline ScanTarget scan_of(const FitModel& model, const BodyState& state, int count, std::uint32_t seed) {
  PosedModel posed;
  posed.update(model, state);
  return ScanTarget::sample(posed.vertices, model.body.faces, posed.normals, count, seed);
}

/// Largest distance between joints of two states among the 22 of the contract, m.
inline double joint_distance(const BodyModel& body, const BodyState& a, const BodyState& b) {
  return (pose_skeleton(body, a).joints - pose_skeleton(body, b).joints)
      .leftCols(22)
      .colwise()
      .norm()
      .maxCoeff();
}

/// Turns every joint but the root by about `angle` rad, and changes betas by about `shape`.
inline BodyState perturbed(const BodyState& state, double angle, double shape, std::uint32_t seed) {
  Random random(seed);
  Points3d pose = state.axis_angle();
  for (Index i = 3; i < pose.size(); ++i) pose.data()[i] += angle / std::sqrt(3.0) * random.normal();
  Eigen::VectorXd betas = state.betas;
  for (Index k = 0; k < betas.size(); ++k) betas[k] += shape * random.normal();
  return BodyState::from_axis_angle(pose, betas, state.translation);
}

}  // namespace vitruvian::testing
