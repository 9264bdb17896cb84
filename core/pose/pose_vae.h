#pragma once

#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Dense layer y = f(weight x + bias), f(u) = u for u > 0, negative_slope * u else; slope 1 makes it linear.
struct DenseLayer {
  Eigen::MatrixXd weight;  ///< out x in
  Eigen::VectorXd bias;    ///< out
  double negative_slope = 1;
};

/// Variational autoencoder of body poses, of VPoser's structure (Pavlakos et al. 2019, section 3.3): the 21
/// body joints (root and hands left out) as 63 axis-angle numbers, joint-major, to and from a latent code
/// that is standard normal over human poses. The decoder ends in a row-major 3x2 matrix a joint whose columns
/// become a rotation by Gram-Schmidt (Zhou et al. 2019).
struct PoseVae {
  static constexpr int kJoints = 21;

  std::vector<DenseLayer> encoder;  ///< 63 -> ... -> latent mean
  std::vector<DenseLayer> decoder;  ///< latent -> ... -> 6 * 21

  bool empty() const { return decoder.empty(); }
  int latent_count() const { return empty() ? 0 : static_cast<int>(decoder.front().weight.cols()); }
};

/// One decoded latent code, with what its derivatives need. The network must outlive it.
class DecodedPose {
 public:
  DecodedPose(const PoseVae& vae, const Eigen::VectorXd& z);

  /// Rotations of joints 1..21 relative to their parents.
  const std::vector<Mat3d>& rotations() const { return rotations_; }
  /// The same as 63 axis-angle numbers, joint-major.
  Eigen::VectorXd axis_angle() const;
  /// d axis_angle / d z, 63 x latent.
  Eigen::MatrixXd axis_angle_jacobian() const;
  /// Reverse mode: gradient by z (latent) of a function whose gradient by small turns is given: `by_turn`
  /// (63) holds, for each joint, the derivative by w in rotation <- exp(w) rotation.
  Eigen::VectorXd pull_back(const Eigen::VectorXd& by_turn) const;

 private:
  /// 3 x 6: turn w of a joint's rotation for a change of its six decoder outputs.
  using TurnByOutput = Eigen::Matrix<double, 3, 6>;

  const PoseVae& vae_;
  std::vector<Eigen::VectorXd> slopes_;  ///< derivative of each layer's nonlinearity at its input
  std::vector<Mat3d> rotations_;
  std::vector<TurnByOutput> turn_by_output_;
};

/// Pose (63 axis-angle numbers) of a latent code.
Eigen::VectorXd decode(const PoseVae& vae, const Eigen::VectorXd& z);

/// Mean latent code of a pose (63 axis-angle numbers, joints 1..21).
Eigen::VectorXd encode(const PoseVae& vae, const Eigen::VectorXd& pose);

}  // namespace vitruvian
