#include "pose/inverse_kinematics_objective.h"

#include <algorithm>

#include "pose/rotation.h"

namespace vitruvian {
namespace {

/// Derivative by a small turn, body frame, of everything below a joint about that joint.
Vec3d torque(const Points3d& joints, const Points3d& force, const Points3d& moment, int j) {
  return moment.col(j) - Vec3d(joints.col(j)).cross(Vec3d(force.col(j)));
}

}  // namespace

InverseKinematicsObjective::InverseKinematicsObjective(const BodyModel& model, const PoseVae& vae,
                                                       const Points3d& targets,
                                                       const Eigen::VectorXd& weights,
                                                       const InverseKinematicsOptions& options)
    : model_(model),
      vae_(vae),
      targets_(targets),
      weights_(weights),
      options_(options),
      latent_(vae.latent_count()),
      betas_(std::clamp(options.betas, 0, static_cast<int>(model.joint_shapedirs.cols()))) {}

InverseKinematicsObjective::Pose InverseKinematicsObjective::pose(const DecodedPose& decoded,
                                                                  const Eigen::VectorXd& x) const {
  Pose p;
  p.rotation.assign(joint_count(), Mat3d::Identity());
  p.rotation[0] = rotation_from_vector<double>(x.segment<3>(latent_ + betas_)) * start_root;
  for (int j = 1; j <= PoseVae::kJoints; ++j) p.rotation[j] = decoded.rotations()[j - 1];
  p.rest = model_.joint_template;
  const Eigen::VectorXd moved = model_.joint_shapedirs.leftCols(betas_) * x.segment(latent_, betas_);
  p.rest += Eigen::Map<const Points3d>(moved.data(), 3, joint_count());
  p.global = p.rotation;
  p.joints.resize(3, joint_count());
  p.joints.col(0) = p.rest.col(0) + x.tail<3>();
  for (int j = 1; j < joint_count(); ++j) {
    const int parent = model_.parent[j];
    p.global[j] = p.global[parent] * p.rotation[j];
    p.joints.col(j) = p.joints.col(parent) + p.global[parent] * (p.rest.col(j) - p.rest.col(parent));
  }
  return p;
}

double InverseKinematicsObjective::operator()(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const {
  const DecodedPose decoded(vae_, x.head(latent_));
  const Pose p = pose(decoded, x);

  // Sums over the joints below each joint: of the derivative by place ("force"), and of place x force
  // ("moment").
  Points3d force = Points3d::Zero(3, joint_count()), moment = Points3d::Zero(3, joint_count());
  double cost = 0;
  for (int j = 0; j < kTargets; ++j) {
    if (weights_[j] == 0) continue;
    const Vec3d error = p.joints.col(j) - targets_.col(j);
    cost += options_.data_weight * weights_[j] * error.squaredNorm();
    force.col(j) = 2 * options_.data_weight * weights_[j] * error;
    moment.col(j) = Vec3d(p.joints.col(j)).cross(Vec3d(force.col(j)));
  }
  for (int j = joint_count() - 1; j > 0; --j) {
    force.col(model_.parent[j]) += force.col(j);
    moment.col(model_.parent[j]) += moment.col(j);
  }

  Eigen::VectorXd by_turn(3 * PoseVae::kJoints);
  Points3d by_rest(3, joint_count());  // gradient by each joint's rest offset from its parent
  by_rest.col(0) = force.col(0);
  for (int j = 1; j < joint_count(); ++j) {
    const Mat3d& parent = p.global[model_.parent[j]];
    by_rest.col(j) = parent.transpose() * force.col(j);
    if (j > PoseVae::kJoints) continue;
    by_turn.segment<3>(3 * (j - 1)) = parent.transpose() * torque(p.joints, force, moment, j);
  }

  const auto z = x.head(latent_);
  const auto betas = x.segment(latent_, betas_);
  cost += options_.latent_weight * z.squaredNorm() + options_.shape_weight * betas.squaredNorm();
  gradient.head(latent_) = decoded.pull_back(by_turn) + 2 * options_.latent_weight * z;
  // From offsets to joints: a joint's rest place is its own offset's end and its children's start.
  Points3d by_joint = by_rest;
  for (int j = 1; j < joint_count(); ++j) by_joint.col(model_.parent[j]) -= by_rest.col(j);
  gradient.segment(latent_, betas_) =
      model_.joint_shapedirs.leftCols(betas_).transpose() *
          Eigen::Map<const Eigen::VectorXd>(by_joint.data(), by_joint.size()) +
      2 * options_.shape_weight * betas;
  gradient.segment<3>(latent_ + betas_) =
      left_jacobian<double>(x.segment<3>(latent_ + betas_)).transpose() * torque(p.joints, force, moment, 0);
  gradient.tail<3>() = force.col(0);
  return cost;
}

}  // namespace vitruvian
