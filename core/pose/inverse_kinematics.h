#pragma once

#include <optional>

#include "base/execution.h"
#include "base/types.h"
#include "body/model.h"
#include "pose/pose_vae.h"

namespace vitruvian {

/// Weights of the paper's section 3.1.4.
struct InverseKinematicsOptions {
  double data_weight = 20;       ///< alpha, per m^2
  double latent_weight = 0.001;  ///< lambda_z
  double shape_weight = 0.001;   ///< lambda_beta
  int betas = 10;                ///< shape components used; at most the model's, 0 for none
  int iterations = 300;          ///< of L-BFGS
  /// Start of the search with the root unturned (in the canonical frame the rotation vector
  /// (0, pi/sqrt 2, pi/sqrt 2), section 3.1.1) and this translation. Without it the trunk is laid on its
  /// targets, which needs no alignment.
  std::optional<Vec3d> start_translation;
};

struct InverseKinematicsResult {
  Points3d pose;          ///< 3 x J axis-angle, root first; hands and face at rest
  Eigen::VectorXd betas;  ///< as many as used
  Vec3d translation = Vec3d::Zero();
  Eigen::VectorXd z;  ///< latent code
  Points3d joints;    ///< 3 x J, body frame, what the parameters give
  double cost = 0;    ///< the objective's value
  double initial_cost = 0;
  int iterations = 0;
};

/// Pose and shape whose joints come nearest to targets, over the poses a variational autoencoder knows:
/// minimises
///   E'(beta, z) = alpha sum_i w_i |Q_i(beta, Decoder(z)) - p_i|^2 + lambda_z |z|^2 + lambda_beta |beta|^2
/// (paper, section 3.1.4) over the latent code z, the shape, and the root's orientation and place, by L-BFGS.
/// The search starts at z = 0, mean shape, with the trunk laid on its targets (Procrustes) or as
/// `start_translation` says.
///
/// @param model        its first 22 joints in SMPL order; further ones (hands, face) stay at rest.
/// @param targets      3 x 22, body frame, metres, in SMPL order; columns of confidence 0 are not read.
/// @param confidences  22, w_i in [0, 1].
/// @throws Error(bad_model) when the model has fewer joints or the prior no autoencoder; Error(no_geometry)
/// when fewer
///         than three targets can be used or one is not finite; Error(cancelled).
InverseKinematicsResult solve_inverse_kinematics(const BodyModel& model, const PoseVae& vae,
                                                 const Points3d& targets, const Eigen::VectorXd& confidences,
                                                 const InverseKinematicsOptions& options,
                                                 const Execution& execution);

}  // namespace vitruvian
