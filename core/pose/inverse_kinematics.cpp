#include "pose/inverse_kinematics.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "pose/inverse_kinematics_objective.h"
#include "pose/lbfgs.h"
#include "pose/rotation.h"

namespace vitruvian {
namespace {

using Objective = InverseKinematicsObjective;
constexpr int kTargets = Objective::kTargets;
/// Joints that move little against each other: pelvis, hips, spine, neck, collars, shoulders.
constexpr int kTrunk[] = {0, 1, 2, 3, 6, 9, 12, 13, 14, 16, 17};

/// Sets the root's orientation and place in x so that the trunk (or, with too little of it seen, every joint)
/// lies on its targets.
void lay_trunk(Objective& objective, const PoseVae& vae, const Points3d& targets,
               const Eigen::VectorXd& weights, Eigen::VectorXd& x) {
  const DecodedPose decoded(vae, x.head(objective.latent()));
  const Points3d joints = objective.pose(decoded, x).joints;
  Eigen::VectorXd used = Eigen::VectorXd::Zero(kTargets);
  for (const int j : kTrunk) used[j] = weights[j];
  if ((used.array() > 0).count() < 3) used = weights;
  const double sum = used.sum();
  const Vec3d from = joints.leftCols(kTargets) * used / sum;
  Vec3d to = Vec3d::Zero();
  Mat3d covariance = Mat3d::Zero();
  for (int j = 0; j < kTargets; ++j) {
    if (used[j] > 0) to += used[j] / sum * targets.col(j);
  }
  for (int j = 0; j < kTargets; ++j) {
    if (used[j] > 0) covariance += used[j] * (targets.col(j) - to) * (joints.col(j) - from).transpose();
  }
  objective.start_root = nearest_rotation(covariance);
  // The root turns about the pelvis.
  const Vec3d pelvis = joints.col(0);
  x.tail<3>() = to - objective.start_root * (from - pelvis) - pelvis;
}

void check(const BodyModel& model, const PoseVae& vae, const Points3d& targets,
           const Eigen::VectorXd& weights) {
  if (model.joint_count() < kTargets) {
    throw Error(ErrorCode::bad_model,
                model.name +
                    ": inverse kinematics needs a model whose first 22 joints are SMPL's, this "
                    "one has " +
                    std::to_string(model.joint_count()));
  }
  if (vae.empty()) {
    throw Error(ErrorCode::bad_model,
                "the pose prior holds no autoencoder, which inverse kinematics in latent space needs; use a "
                "prior made "
                "with scripts/models/pose/make_prior.py --vae");
  }
  if (targets.cols() != kTargets || weights.size() != kTargets) {
    throw Error(ErrorCode::internal, "inverse kinematics: 22 targets and confidences expected");
  }
  if (!weights.allFinite() || weights.minCoeff() < 0) {
    throw Error(ErrorCode::internal, "inverse kinematics: a confidence is negative or not finite");
  }
  int usable = 0;
  for (int j = 0; j < kTargets; ++j) {
    if (weights[j] == 0) continue;
    ++usable;
    if (!targets.col(j).allFinite()) {
      throw Error(ErrorCode::no_geometry, "inverse kinematics: the target of joint " +
                                              std::string(kSmplJointNames[static_cast<std::size_t>(j)]) +
                                              " is not finite");
    }
  }
  if (usable < 3) {
    throw Error(ErrorCode::no_geometry,
                "inverse kinematics needs at least 3 joints with a confidence above 0, got " +
                    std::to_string(usable) + "; set more keypoints by hand");
  }
}

}  // namespace

InverseKinematicsResult solve_inverse_kinematics(const BodyModel& model, const PoseVae& vae,
                                                 const Points3d& targets, const Eigen::VectorXd& confidences,
                                                 const InverseKinematicsOptions& options,
                                                 const Execution& execution) {
  check(model, vae, targets, confidences);
  Objective objective(model, vae, targets, confidences, options);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(objective.size());
  if (options.start_translation) {
    x.tail<3>() = *options.start_translation;
  } else {
    lay_trunk(objective, vae, targets, confidences, x);
  }

  LbfgsOptions search;
  search.iterations = options.iterations;
  search.gradient_tolerance = 1e-7;
  search.decrease_tolerance = 1e-7;
  InverseKinematicsResult result;
  Eigen::VectorXd gradient(objective.size());
  result.initial_cost = objective(x, gradient);
  const LbfgsResult found = minimize_lbfgs(
      [&](const Eigen::VectorXd& at, Eigen::VectorXd& by) {
        execution.check();
        return objective(at, by);
      },
      std::move(x), search);

  const DecodedPose decoded(vae, found.x.head(objective.latent()));
  const Objective::Pose pose = objective.pose(decoded, found.x);
  result.pose.resize(3, model.joint_count());
  for (int j = 0; j < model.joint_count(); ++j) result.pose.col(j) = vector_from_rotation(pose.rotation[j]);
  result.z = found.x.head(objective.latent());
  result.betas = found.x.segment(objective.latent(), objective.betas());
  result.translation = found.x.tail<3>();
  result.joints = pose.joints;
  result.cost = found.value;
  result.iterations = found.iterations;
  return result;
}

}  // namespace vitruvian
