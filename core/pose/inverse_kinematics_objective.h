#pragma once

#include <vector>

#include "body/model.h"
#include "pose/inverse_kinematics.h"
#include "pose/pose_vae.h"

namespace vitruvian {

/// The objective of solve_inverse_kinematics() and its gradient; arguments as there, all to outlive the
/// object. Unknowns in this order: latent code, betas, turn of the root from its starting orientation
/// (rotation vector), translation.
class InverseKinematicsObjective {
 public:
  static constexpr int kTargets = 22;

  InverseKinematicsObjective(const BodyModel& model, const PoseVae& vae, const Points3d& targets,
                             const Eigen::VectorXd& weights, const InverseKinematicsOptions& options);

  int joint_count() const { return model_.joint_count(); }
  int size() const { return latent_ + betas_ + 6; }
  int latent() const { return latent_; }
  int betas() const { return betas_; }

  /// Orientation from which the root's turn is counted.
  Mat3d start_root = Mat3d::Identity();

  struct Pose {
    std::vector<Mat3d> rotation;  ///< J, relative to the parent
    std::vector<Mat3d> global;    ///< J, body_from_joint
    Points3d rest, joints;        ///< 3 x J
  };
  /// Forward kinematics at x, whose latent code has been decoded.
  Pose pose(const DecodedPose& decoded, const Eigen::VectorXd& x) const;

  /// Value at x; `gradient` (size()) is overwritten.
  double operator()(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const;

 private:
  const BodyModel& model_;
  const PoseVae& vae_;
  const Points3d& targets_;
  const Eigen::VectorXd& weights_;
  const InverseKinematicsOptions& options_;
  int latent_, betas_;
};

}  // namespace vitruvian
