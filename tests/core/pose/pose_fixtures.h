#pragma once

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/random.h"
#include "body/model.h"
#include "pose/pose_prior.h"

namespace vitruvian::testing {

inline std::vector<std::byte> file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

/// The prior that the program ships.
inline const PosePrior& shipped_prior() {
  static const PosePrior prior =
      read_pose_prior(file_bytes(VITRUVIAN_SOURCE_DIR "/models/pose_prior.vpp"), "pose_prior.vpp");
  return prior;
}

constexpr std::size_t kUnusualPoses = 60;

/// Motion-capture poses that the prior has not learnt from: 3 x 24 axis-angle each, root first.
inline std::vector<Points3d> test_side_poses() {
  std::ifstream file(VITRUVIAN_SOURCE_DIR "/tests/data/test_poses.csv");
  std::vector<Points3d> poses;
  for (std::string line; std::getline(file, line);) {
    Points3d pose(3, 24);
    std::istringstream fields(line);
    std::string field;
    for (Index i = 0; i < 72 && std::getline(fields, field, ','); ++i) pose.data()[i] = std::stod(field);
    poses.push_back(pose);
  }
  if (poses.size() < kUnusualPoses) throw std::runtime_error("tests/data/test_poses.csv: too few rows");
  poses.resize(kUnusualPoses);
  return poses;
}

/// A 24-joint model of an average adult that has joints only; its shape components scale body parts at
/// random.
inline BodyModel skeleton_model(std::uint32_t seed) {
  BodyModel model;
  model.name = "skeleton";
  model.parent = {-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};
  model.joint_template.resize(3, 24);
  model.joint_template.transpose() << 0, 0, 0, 0.09, -0.07, 0, -0.09, -0.07, 0, 0, 0.1, -0.02, 0.11, -0.45,
      0.01, -0.11, -0.45, 0.01, 0, 0.23, -0.01, 0.1, -0.86, -0.03, -0.1, -0.86, -0.03, 0, 0.29, 0.01, 0.12,
      -0.92, 0.1, -0.12, -0.92, 0.1, 0, 0.5, -0.03, 0.08, 0.4, -0.02, -0.08, 0.4, -0.02, 0, 0.57, 0.02, 0.18,
      0.42, -0.03, -0.18, 0.42, -0.03, 0.43, 0.42, -0.05, -0.43, 0.42, -0.05, 0.68, 0.42, -0.05, -0.68, 0.42,
      -0.05, 0.77, 0.42, -0.06, -0.77, 0.42, -0.06;
  constexpr int kBetas = 12;
  Random random(seed);
  model.joint_shapedirs.resize(72, kBetas);
  for (int k = 0; k < kBetas; ++k) {
    const Vec3d scale(0.03 * random.normal(), 0.03 * random.normal(), 0.03 * random.normal());
    for (int j = 0; j < 24; ++j) {
      model.joint_shapedirs.block<3, 1>(3 * j, k) = scale.cwiseProduct(Vec3d(model.joint_template.col(j)));
      for (int c = 0; c < 3; ++c) model.joint_shapedirs(3 * j + c, k) += 0.001 * random.normal();
    }
  }
  return model;
}

/// A network of VPoser's form and any size with random weights.
inline PoseVae random_vae(std::uint32_t seed, int latent, int width) {
  Random random(seed);
  const auto layer = [&](int outputs, int inputs, double slope) {
    DenseLayer result{Eigen::MatrixXd(outputs, inputs), Eigen::VectorXd(outputs), slope};
    for (Index i = 0; i < result.weight.size(); ++i)
      result.weight.data()[i] = random.normal() / std::sqrt(inputs);
    for (Index i = 0; i < result.bias.size(); ++i) result.bias[i] = 0.3 * random.normal();
    return result;
  };
  return {{layer(width, 63, 0.01), layer(width, width, 0.01), layer(latent, width, 1)},
          {layer(width, latent, 0.01), layer(width, width, 0.01), layer(126, width, 1)}};
}

}  // namespace vitruvian::testing
