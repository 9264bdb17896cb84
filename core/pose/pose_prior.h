#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "base/types.h"
#include "pose/pose_vae.h"

namespace vitruvian {

enum class Limb { left_arm = 0, right_arm = 1, left_leg = 2, right_leg = 3 };

/// Typical configurations of one limb: rotations of shoulder and elbow, or hip and knee, relative to their
/// parents. An arm's are those of a collar at rest.
struct LimbLibrary {
  /// 6 x n: axis-angle of the upper joint, then of the lower one.
  Eigen::Matrix<double, 6, Eigen::Dynamic> configurations;
  int upper_joint = 0, lower_joint = 0;  ///< SMPL joint indices
};

/// What is known of human poses without looking at a scan. A pose here is the 69 parent-relative axis-angle
/// numbers of joints 1..23, joint-major, rad.
struct PosePrior {
  static constexpr int kSize = 69;

  Eigen::VectorXd mean;       ///< 69
  Eigen::MatrixXd precision;  ///< 69 x 69, symmetric positive definite; a weak Gaussian, wider than the data
  Eigen::VectorXd limit_low;  ///< 69, joint limits; below limit_high everywhere
  Eigen::VectorXd limit_high;
  std::array<LimbLibrary, 4> limbs;  ///< by Limb
  PoseVae vae;                       ///< empty when the file holds none
  std::string metadata;              ///< JSON: where it comes from
  std::string sha256;                ///< of the file

  const LimbLibrary& limb(Limb which) const { return limbs[static_cast<int>(which)]; }
};

/// Reads a pose prior file (models/README.md, kind POSE) and validates every shape and value.
/// @param name  the file's name, shown in errors.
/// @throws Error(bad_model).
PosePrior read_pose_prior(std::span<const std::byte> bytes, const std::string& name);

}  // namespace vitruvian
