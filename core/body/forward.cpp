#include "body/forward.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <numbers>

namespace vitruvian {
namespace {

/// The unit quaternion whose scalar part is not negative.
Eigen::Quaterniond short_quaternion(const Mat3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() *= -1;
  return q;
}

}  // namespace

BodyState BodyState::rest(const BodyModel& model) {
  BodyState state;
  state.rotation.assign(model.joint_count(), Mat3d::Identity());
  state.betas = Eigen::VectorXd::Zero(model.beta_count());
  return state;
}

BodyState BodyState::from_axis_angle(const Points3d& pose, const Eigen::VectorXd& betas,
                                     const Vec3d& translation) {
  BodyState state;
  state.rotation.resize(pose.cols());
  for (Index j = 0; j < pose.cols(); ++j) {
    const double angle = pose.col(j).norm();
    state.rotation[j] =
        angle > 0 ? Eigen::AngleAxisd(angle, pose.col(j) / angle).toRotationMatrix() : Mat3d::Identity();
  }
  state.betas = betas;
  state.translation = translation;
  return state;
}

Points3d BodyState::axis_angle() const {
  Points3d pose(3, static_cast<Index>(rotation.size()));
  for (std::size_t j = 0; j < rotation.size(); ++j) {
    // Through a quaternion: accurate near zero and near a half turn, where the matrix's trace is not.
    const Eigen::Quaterniond q = short_quaternion(rotation[j]);
    const double sine = q.vec().norm();
    const double scale = sine > 1e-12 ? 2 * std::atan2(sine, q.w()) / sine : 2.0;
    pose.col(static_cast<Index>(j)) = scale * q.vec();
  }
  return pose;
}

Skeleton pose_skeleton(const BodyModel& model, const BodyState& state) {
  const int joints = model.joint_count();
  Skeleton skeleton;
  skeleton.rest_joints = model.joint_template;
  const Eigen::VectorXd moved = model.joint_shapedirs.leftCols(state.betas.size()) * state.betas;
  skeleton.rest_joints += Eigen::Map<const Points3d>(moved.data(), 3, joints);
  skeleton.global.resize(joints);
  skeleton.joints.resize(3, joints);
  for (int j = 0; j < joints; ++j) {
    const int p = model.parent[j];
    if (p < 0) {
      skeleton.global[j] = state.rotation[j];
      skeleton.joints.col(j) = skeleton.rest_joints.col(j) + state.translation;
    } else {
      skeleton.global[j] = skeleton.global[p] * state.rotation[j];
      skeleton.joints.col(j) = skeleton.joints.col(p) + skeleton.global[p] * (skeleton.rest_joints.col(j) -
                                                                              skeleton.rest_joints.col(p));
    }
  }
  return skeleton;
}

Eigen::Matrix<double, 9, 1> pose_feature(PoseFeature kind, const Mat3d& rotation) {
  Eigen::Matrix<double, 9, 1> feature = Eigen::Matrix<double, 9, 1>::Zero();
  if (kind == PoseFeature::quaternion) {
    const Eigen::Quaterniond q = short_quaternion(rotation);
    feature.head<4>() << q.vec(), q.w() - 1;
  } else {
    for (int k = 0; k < 9; ++k) feature[k] = rotation(k / 3, k % 3) - (k / 3 == k % 3 ? 1 : 0);
  }
  return feature;
}

Eigen::Matrix<double, 9, 3> pose_feature_by_turn(PoseFeature kind, const Mat3d& rotation) {
  Eigen::Matrix<double, 9, 3> derivative = Eigen::Matrix<double, 9, 3>::Zero();
  const Eigen::Quaterniond q = short_quaternion(rotation);
  for (int c = 0; c < 3; ++c) {
    const Vec3d axis = Vec3d::Unit(c);
    if (kind == PoseFeature::quaternion) {
      derivative.col(c).head<3>() = 0.5 * (q.w() * axis + axis.cross(Vec3d(q.vec())));
      derivative(3, c) = -0.5 * q.vec()[c];
    } else {
      for (int k = 0; k < 9; ++k) derivative(k, c) = axis.cross(Vec3d(rotation.col(k % 3)))[k / 3];
    }
  }
  return derivative;
}

template <typename Scalar>
void shape_vertices(const BodyModel& model, const Eigen::VectorXd& betas, VertexMatrix<Scalar>& rest) {
  rest = model.v_template.cast<Scalar>();
  Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> flat(rest.data(), rest.size());
  const Eigen::Matrix<Scalar, Eigen::Dynamic, 1> b = betas.cast<Scalar>();
  if constexpr (std::is_same_v<Scalar, float>) {
    flat.noalias() += model.shapedirs.leftCols(b.size()) * b;
  } else {
    for (Index k = 0; k < b.size(); ++k) {
      if (b[k] != 0) flat += b[k] * model.shapedirs.col(k).template cast<Scalar>();
    }
  }
}

template <typename Scalar>
void add_correctives(const BodyModel& model, const BodyState& state, VertexMatrix<Scalar>& rest) {
  const int joints = model.joint_count();
  Eigen::Matrix<Scalar, 9, Eigen::Dynamic> feature(9, joints);
  for (int j = 0; j < joints; ++j)
    feature.col(j) = pose_feature(model.pose_feature, state.rotation[j]).template cast<Scalar>();
  for (int v = 0; v < model.vertex_count(); ++v) {
    for (int b = model.corrective_begin[v]; b < model.corrective_begin[v + 1]; ++b) {
      rest.col(v) += model.corrective[b].template cast<Scalar>() * feature.col(model.corrective_joint[b]);
    }
  }
}

template <typename Scalar>
void skin_vertices(const BodyModel& model, const Skeleton& skeleton, const VertexMatrix<Scalar>& rest,
                   VertexMatrix<Scalar>& posed) {
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  const int joints = model.joint_count();
  std::vector<Matrix3> rotation(joints);
  std::vector<Vector3> offset(joints);
  for (int j = 0; j < joints; ++j) {
    rotation[j] = skeleton.global[j].cast<Scalar>();
    offset[j] = (skeleton.joints.col(j) - skeleton.global[j] * skeleton.rest_joints.col(j)).cast<Scalar>();
  }
  const Index per_vertex = model.skin_joint.rows();
  posed.resize(3, rest.cols());
  for (Index v = 0; v < rest.cols(); ++v) {
    Matrix3 blended = Matrix3::Zero();
    Vector3 shift = Vector3::Zero();
    for (Index k = 0; k < per_vertex; ++k) {
      const Scalar weight = static_cast<Scalar>(model.skin_weight(k, v));
      if (weight == 0) break;
      blended += weight * rotation[model.skin_joint(k, v)];
      shift += weight * offset[model.skin_joint(k, v)];
    }
    posed.col(v) = blended * rest.col(v) + shift;
  }
}

template <typename Scalar>
VertexMatrix<Scalar> posed_vertices(const BodyModel& model, const BodyState& state, const Points3f& offsets) {
  VertexMatrix<Scalar> rest, posed;
  shape_vertices(model, state.betas, rest);
  add_correctives(model, state, rest);
  if (offsets.cols() > 0) rest += offsets.cast<Scalar>();
  skin_vertices(model, pose_skeleton(model, state), rest, posed);
  return posed;
}

Points3f offsets_from_displacements(const BodyModel& model, const Skeleton& skeleton,
                                    const Points3d& displacement) {
  // Blended rotations have singular values in [0, 1]; below this one a direction counts as lost.
  constexpr double kLeastStretch = 0.2;
  Points3f offsets(3, displacement.cols());
  for (Index v = 0; v < displacement.cols(); ++v) {
    Mat3d blended = Mat3d::Zero();
    for (Index k = 0; k < model.skin_joint.rows(); ++k) {
      const double weight = model.skin_weight(k, v);
      if (weight == 0) break;
      blended += weight * skeleton.global[model.skin_joint(k, v)];
    }
    const Eigen::JacobiSVD<Mat3d> svd(blended, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3d along = svd.matrixU().transpose() * displacement.col(v);
    for (int k = 0; k < 3; ++k) {
      const double stretch = svd.singularValues()[k];
      along[k] = stretch > kLeastStretch ? along[k] / stretch : 0;
    }
    offsets.col(v) = (svd.matrixV() * along).cast<float>();
  }
  return offsets;
}

#define VITRUVIAN_INSTANTIATE(Scalar)                                                            \
  template void shape_vertices(const BodyModel&, const Eigen::VectorXd&, VertexMatrix<Scalar>&); \
  template void add_correctives(const BodyModel&, const BodyState&, VertexMatrix<Scalar>&);      \
  template void skin_vertices(const BodyModel&, const Skeleton&, const VertexMatrix<Scalar>&,    \
                              VertexMatrix<Scalar>&);                                            \
  template VertexMatrix<Scalar> posed_vertices(const BodyModel&, const BodyState&, const Points3f&);
VITRUVIAN_INSTANTIATE(float)
VITRUVIAN_INSTANTIATE(double)
#undef VITRUVIAN_INSTANTIATE

}  // namespace vitruvian
