#include "pose/pose_vae.h"

#include <algorithm>

#include "pose/rotation.h"

namespace vitruvian {
namespace {

/// Keeps Gram-Schmidt finite when a network puts out a vanishing column.
constexpr double kLeastLength = 1e-8;

/// Applies a layer; `slope` receives the derivative of its nonlinearity.
Eigen::VectorXd apply(const DenseLayer& layer, const Eigen::VectorXd& input, Eigen::VectorXd& slope) {
  Eigen::VectorXd output = layer.weight * input + layer.bias;
  slope = (output.array() > 0).select(Eigen::VectorXd::Ones(output.size()), layer.negative_slope);
  output.array() *= slope.array();
  return output;
}

}  // namespace

DecodedPose::DecodedPose(const PoseVae& vae, const Eigen::VectorXd& z) : vae_(vae) {
  Eigen::VectorXd x = z;
  slopes_.resize(vae.decoder.size());
  for (std::size_t k = 0; k < vae.decoder.size(); ++k) x = apply(vae.decoder[k], x, slopes_[k]);

  rotations_.resize(PoseVae::kJoints);
  turn_by_output_.resize(PoseVae::kJoints);
  for (int j = 0; j < PoseVae::kJoints; ++j) {
    const Vec3d a1(x[6 * j], x[6 * j + 2], x[6 * j + 4]), a2(x[6 * j + 1], x[6 * j + 3], x[6 * j + 5]);
    const double length1 = std::max(a1.norm(), kLeastLength);
    const Vec3d b1 = a1 / length1;
    const double along = b1.dot(a2);
    const Vec3d u2 = a2 - along * b1;
    const double length2 = std::max(u2.norm(), kLeastLength);
    const Vec3d b2 = u2 / length2;
    const Vec3d b3 = b1.cross(b2);
    rotations_[j] << b1, b2, b3;

    // A turn w moves the columns by w x b: read its three components off the moved columns.
    const Eigen::RowVector3d third1 = b3.transpose() / length1;
    Eigen::Matrix<double, 3, 3> by_a1 =
        b3 * b2.transpose() / length1 - b2 * third1 - b1 * (along / length2) * third1;
    const Eigen::Matrix<double, 3, 3> by_a2 = b1 * b3.transpose() / length2;
    for (int k = 0; k < 3; ++k) {
      turn_by_output_[j].col(2 * k) = by_a1.col(k);
      turn_by_output_[j].col(2 * k + 1) = by_a2.col(k);
    }
  }
}

Eigen::VectorXd DecodedPose::axis_angle() const {
  Eigen::VectorXd pose(3 * PoseVae::kJoints);
  for (int j = 0; j < PoseVae::kJoints; ++j) pose.segment<3>(3 * j) = vector_from_rotation(rotations_[j]);
  return pose;
}

Eigen::MatrixXd DecodedPose::axis_angle_jacobian() const {
  Eigen::MatrixXd by_z = slopes_[0].asDiagonal() * vae_.decoder[0].weight;
  for (std::size_t k = 1; k < vae_.decoder.size(); ++k) {
    by_z = (slopes_[k].asDiagonal() * (vae_.decoder[k].weight * by_z)).eval();
  }
  Eigen::MatrixXd jacobian(3 * PoseVae::kJoints, by_z.cols());
  for (int j = 0; j < PoseVae::kJoints; ++j) {
    const Vec3d v = vector_from_rotation(rotations_[j]);
    jacobian.middleRows<3>(3 * j) = left_jacobian_inverse(v) * turn_by_output_[j] * by_z.middleRows<6>(6 * j);
  }
  return jacobian;
}

Eigen::VectorXd DecodedPose::pull_back(const Eigen::VectorXd& by_turn) const {
  Eigen::VectorXd gradient(6 * PoseVae::kJoints);
  for (int j = 0; j < PoseVae::kJoints; ++j) {
    gradient.segment<6>(6 * j) = turn_by_output_[j].transpose() * by_turn.segment<3>(3 * j);
  }
  for (std::size_t k = vae_.decoder.size(); k-- > 0;) {
    gradient = (vae_.decoder[k].weight.transpose() * slopes_[k].cwiseProduct(gradient)).eval();
  }
  return gradient;
}

Eigen::VectorXd decode(const PoseVae& vae, const Eigen::VectorXd& z) {
  return DecodedPose(vae, z).axis_angle();
}

Eigen::VectorXd encode(const PoseVae& vae, const Eigen::VectorXd& pose) {
  Eigen::VectorXd x = pose, slope;
  for (const DenseLayer& layer : vae.encoder) x = apply(layer, x, slope);
  return x;
}

}  // namespace vitruvian
