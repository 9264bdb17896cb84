#include "body/jacobian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace vitruvian {
namespace {

template <typename Derived>
Eigen::Matrix<typename Derived::Scalar, 3, 3> cross_matrix(const Eigen::MatrixBase<Derived>& a) {
  Eigen::Matrix<typename Derived::Scalar, 3, 3> m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// Blocks of a vertex in ascending order, all or the `most` largest.
std::vector<int> strongest_blocks(const BodyModel& model, int vertex, int most) {
  std::vector<int> blocks;
  for (int b = model.corrective_begin[vertex]; b < model.corrective_begin[vertex + 1]; ++b)
    blocks.push_back(b);
  if (most > 0 && static_cast<int>(blocks.size()) > most) {
    std::nth_element(blocks.begin(), blocks.begin() + most, blocks.end(), [&](int a, int b) {
      const float size_a = model.corrective[a].squaredNorm(), size_b = model.corrective[b].squaredNorm();
      return size_a != size_b ? size_a > size_b : a < b;
    });
    blocks.resize(most);
    std::sort(blocks.begin(), blocks.end());
  }
  return blocks;
}

}  // namespace

AncestorGroups::AncestorGroups(const BodyModel& model, int most_correctives, float least_weight) {
  const int joint_count = model.joint_count();
  ancestors.assign(joint_count, 0);
  for (int j = 0; j < joint_count; ++j) {
    ancestors[j] = std::uint64_t{1} << j;
    if (model.parent[j] >= 0) ancestors[j] |= ancestors[model.parent[j]];
  }
  std::map<std::uint64_t, int> known;
  group_of_vertex.resize(model.vertex_count());
  block_begin.assign(1, 0);
  for (int v = 0; v < model.vertex_count(); ++v) {
    std::uint64_t mask = 0;
    for (Index k = 0; k < model.skin_joint.rows(); ++k) {
      if (model.skin_weight(k, v) > least_weight) mask |= ancestors[model.skin_joint(k, v)];
    }
    const std::vector<int> counted = strongest_blocks(model, v, most_correctives);
    for (const int b : counted) mask |= std::uint64_t{1} << model.corrective_joint[b];
    const auto [entry, added] = known.try_emplace(mask, static_cast<int>(joints.size()));
    if (added) {
      joints.emplace_back();
      for (int j = 0; j < joint_count; ++j) {
        if (mask >> j & 1) joints.back().push_back(j);
      }
    }
    group_of_vertex[v] = entry->second;
    const std::vector<int>& members = joints[entry->second];
    for (const int b : counted) {
      block.push_back(b);
      const auto place = std::lower_bound(members.begin(), members.end(), model.corrective_joint[b]);
      block_slot.push_back(static_cast<int>(place - members.begin()));
    }
    block_begin.push_back(static_cast<int>(block.size()));
  }
}

template <typename Scalar>
BodyJacobian<Scalar>::BodyJacobian(const BodyModel& model, const AncestorGroups& groups,
                                   const BodyState& state, const Skeleton& skeleton,
                                   const VertexMatrix<Scalar>& rest)
    : model_(model),
      groups_(groups),
      rest_(rest),
      betas_(static_cast<int>(state.betas.size())),
      joints_(skeleton.joints.cast<Scalar>()),
      joints_double_(skeleton.joints) {
  const int joints = model.joint_count();
  rotation_.resize(joints);
  offset_.resize(joints);
  joint_by_betas_.resize(joints);
  offset_by_betas_.resize(joints);
  rotation_by_increment_.resize(joints);
  for (int j = 0; j < joints; ++j) {
    const int p = model.parent[j];
    const Mat3d& global = skeleton.global[j];
    rotation_[j] = global.cast<Scalar>();
    offset_[j] = (skeleton.joints.col(j) - global * skeleton.rest_joints.col(j)).cast<Scalar>();
    const auto own = model.joint_shapedirs.middleRows<3>(3 * j).leftCols(betas_);
    if (p < 0) {
      joint_by_betas_[j] = own;
    } else {
      joint_by_betas_[j] =
          joint_by_betas_[p] +
          skeleton.global[p] * (own - model.joint_shapedirs.middleRows<3>(3 * p).leftCols(betas_));
    }
    offset_by_betas_[j] = (joint_by_betas_[j] - global * own).template cast<Scalar>();
    const Mat3d parent_global = p < 0 ? Mat3d::Identity() : skeleton.global[p];
    const Eigen::Matrix<double, 9, 3> by_local = pose_feature_by_turn(model.pose_feature, state.rotation[j]);
    rotation_by_increment_[j] = (by_local * parent_global.transpose()).template cast<Scalar>();
  }
}

template <typename Scalar>
void BodyJacobian<Scalar>::vertex(int v, Eigen::Ref<Compact> out) const {
  const std::vector<int>& joints = groups_.joints[groups_.group_of_vertex[v]];
  const Index per_vertex = model_.skin_joint.rows();
  Matrix3 blended = Matrix3::Zero();
  // Vertex as seen by each of its bones, times the weight.
  Eigen::Matrix<Scalar, 3, kMostSkinWeights> part;
  Index used = 0;
  auto by_betas = out.middleCols(3 + 3 * static_cast<Index>(joints.size()), betas_);
  by_betas.setZero();
  for (; used < per_vertex; ++used) {
    const Scalar weight = static_cast<Scalar>(model_.skin_weight(used, v));
    if (weight == 0) break;
    const int bone = model_.skin_joint(used, v);
    blended += weight * rotation_[bone];
    part.col(used) = weight * (rotation_[bone] * rest_.col(v) + offset_[bone]);
    by_betas += weight * offset_by_betas_[bone];
  }
  const auto shapedirs = model_.shapedirs.middleRows<3>(3 * v).leftCols(betas_);
  by_betas.noalias() += blended * shapedirs.template cast<Scalar>();
  out.template leftCols<3>().setIdentity();
  for (std::size_t n = 0; n < joints.size(); ++n) {
    const int j = joints[n];
    Vector3 arm = Vector3::Zero();
    for (Index k = 0; k < used; ++k) {
      const int bone = model_.skin_joint(k, v);
      if (groups_.ancestors[bone] >> j & 1) {
        arm += part.col(k) - static_cast<Scalar>(model_.skin_weight(k, v)) * joints_.col(j);
      }
    }
    out.template middleCols<3>(3 + 3 * static_cast<Index>(n)) = -cross_matrix(arm);
  }
  for (int i = groups_.block_begin[v]; i < groups_.block_begin[v + 1]; ++i) {
    const int b = groups_.block[i];
    out.template middleCols<3>(3 + 3 * static_cast<Index>(groups_.block_slot[i])) +=
        blended *
        (model_.corrective[b].template cast<Scalar>() * rotation_by_increment_[model_.corrective_joint[b]]);
  }
}

template <typename Scalar>
typename BodyJacobian<Scalar>::Compact BodyJacobian<Scalar>::full_vertex(int v) const {
  const int group = groups_.group_of_vertex[v];
  const int joint_count = model_.joint_count();
  Compact compact(3, compact_size(group));
  vertex(v, compact);
  Compact full = Compact::Zero(3, 3 + 3 * joint_count + betas_);
  full.template leftCols<3>() = compact.template leftCols<3>();
  const std::vector<int>& joints = groups_.joints[group];
  for (std::size_t n = 0; n < joints.size(); ++n) {
    full.template middleCols<3>(3 + 3 * joints[n]) =
        compact.template middleCols<3>(3 + 3 * static_cast<Index>(n));
  }
  full.rightCols(betas_) = compact.rightCols(betas_);
  return full;
}

template <typename Scalar>
Eigen::MatrixXd BodyJacobian<Scalar>::full_joint(int joint) const {
  const int joint_count = model_.joint_count();
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(3, 3 + 3 * joint_count + betas_);
  full.leftCols<3>().setIdentity();
  for (int j = model_.parent[joint]; j >= 0; j = model_.parent[j]) {
    full.middleCols<3>(3 + 3 * j) = -cross_matrix(Vec3d(joints_double_.col(joint) - joints_double_.col(j)));
  }
  full.rightCols(betas_) = joint_by_betas_[joint];
  return full;
}

template class BodyJacobian<float>;
template class BodyJacobian<double>;

Mat3d axis_angle_chain(const BodyModel& model, const Skeleton& skeleton, const Vec3d& axis_angle, int joint) {
  // d exp(theta) = [Jl(theta) dtheta]x exp(theta), in the parent's frame; the parent's rotation takes it to
  // the body's.
  const double angle = axis_angle.norm();
  const Mat3d k = cross_matrix(axis_angle);
  Mat3d left_jacobian = Mat3d::Identity() + 0.5 * k + k * k / 6;
  if (angle > 1e-4) {
    left_jacobian = Mat3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * k +
                    (angle - std::sin(angle)) / (angle * angle * angle) * k * k;
  }
  const int p = model.parent[joint];
  return p < 0 ? left_jacobian : Mat3d(skeleton.global[p] * left_jacobian);
}

void apply_update(const BodyModel& model, const Skeleton& skeleton, const Eigen::VectorXd& update,
                  BodyState& state) {
  const int joints = model.joint_count();
  state.translation += update.head<3>();
  for (int j = 0; j < joints; ++j) {
    const Vec3d w = update.segment<3>(3 + 3 * j);
    const double angle = w.norm();
    if (angle == 0) continue;
    const Mat3d turn = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
    const int p = model.parent[j];
    const Mat3d parent_global = p < 0 ? Mat3d::Identity() : skeleton.global[p];
    const Mat3d rotation = parent_global.transpose() * turn * parent_global * state.rotation[j];
    state.rotation[j] = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  }
  state.betas += update.tail(state.betas.size());
}

}  // namespace vitruvian
