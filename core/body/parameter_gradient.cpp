#include "body/parameter_gradient.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <mutex>

#include "body/jacobian.h"

namespace vitruvian {
namespace {

/// Sums over vertices that every number's derivative is made of, a column a joint.
struct Sums {
  Points3d force;        ///< derivative by the place of a bone: sum of w g
  Points3d moment;       ///< sum of w x (as that bone sees it) x g
  Eigen::MatrixXd turn;  ///< 9 x J: derivative by the joint's pose feature

  explicit Sums(int joints)
      : force(Points3d::Zero(3, joints)),
        moment(Points3d::Zero(3, joints)),
        turn(Eigen::MatrixXd::Zero(9, joints)) {}

  void operator+=(const Sums& other) {
    force += other.force;
    moment += other.moment;
    turn += other.turn;
  }
};

}  // namespace

ParametricBody::ParametricBody(const BodyModel& model, int betas)
    : model_(model), betas_(std::clamp(betas, 0, model.beta_count())) {}

Eigen::VectorXd ParametricBody::numbers_of(const BodyState& state) const {
  Eigen::VectorXd numbers = Eigen::VectorXd::Zero(size());
  const Points3d pose = state.axis_angle();
  numbers.head<3>() = state.translation;
  numbers.segment(3, pose.size()) = Eigen::Map<const Eigen::VectorXd>(pose.data(), pose.size());
  const Index shared = std::min<Index>(betas_, state.betas.size());
  numbers.tail(betas_).head(shared) = state.betas.head(shared);
  return numbers;
}

BodyState ParametricBody::state_of(const Eigen::VectorXd& numbers) const {
  const Points3d pose = Eigen::Map<const Points3d>(numbers.data() + 3, 3, model_.joint_count());
  return BodyState::from_axis_angle(pose, numbers.tail(betas_), numbers.head<3>());
}

const Points3f& ParametricBody::pose(const Eigen::VectorXd& numbers) {
  axis_angle_ = Eigen::Map<const Points3d>(numbers.data() + 3, 3, model_.joint_count());
  state_ = state_of(numbers);
  skeleton_ = pose_skeleton(model_, state_);
  shape_vertices(model_, state_.betas, rest_);
  add_correctives(model_, state_, rest_);
  skin_vertices(model_, skeleton_, rest_, vertices_);
  return vertices_;
}

void ParametricBody::pull_back(const Points3f& by_vertex, Eigen::VectorXd& by_numbers,
                               const Execution& execution) const {
  const int joints = model_.joint_count();
  std::vector<Mat3f> rotation(joints);
  std::vector<Vec3f> offset(joints);
  for (int j = 0; j < joints; ++j) {
    rotation[j] = skeleton_.global[j].cast<float>();
    offset[j] = (skeleton_.joints.col(j) - skeleton_.global[j] * skeleton_.rest_joints.col(j)).cast<float>();
  }
  Points3f by_rest(3, by_vertex.cols());
  std::map<std::ptrdiff_t, Sums> ranges;  // added up in order, whatever thread was first
  std::mutex mutex;
  execution.parallel_for(by_vertex.cols(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Sums sums(joints);
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      const Vec3f g = by_vertex.col(v), r = rest_.col(v);
      Mat3f blended = Mat3f::Zero();
      for (Index k = 0; k < model_.skin_joint.rows(); ++k) {
        const float weight = model_.skin_weight(k, v);
        if (weight == 0) break;
        const int bone = model_.skin_joint(k, v);
        blended += weight * rotation[bone];
        const Vec3f x = rotation[bone] * r + offset[bone];
        sums.force.col(bone) += (weight * g).cast<double>();
        sums.moment.col(bone) += (weight * x.cross(g)).cast<double>();
      }
      const Vec3f h = blended.transpose() * g;
      by_rest.col(v) = h;
      for (int b = model_.corrective_begin[v]; b < model_.corrective_begin[v + 1]; ++b) {
        sums.turn.col(model_.corrective_joint[b]) += (model_.corrective[b].transpose() * h).cast<double>();
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    ranges.emplace(begin, std::move(sums));
  });
  Sums sums(joints);
  for (const auto& [begin, part] : ranges) sums += part;

  by_numbers.resize(size());
  // From bones to everything below each joint.
  Points3d force = sums.force, moment = sums.moment;
  for (int j = joints - 1; j > 0; --j) {
    force.col(model_.parent[j]) += force.col(j);
    moment.col(model_.parent[j]) += moment.col(j);
  }
  by_numbers.head<3>() = force.col(0);
  Points3d by_joint = Points3d::Zero(3, joints);  // derivative by rest joints
  for (int j = 0; j < joints; ++j) {
    const int p = model_.parent[j];
    const Mat3d parent = p < 0 ? Mat3d::Identity() : skeleton_.global[p];
    const Vec3d torque = Vec3d(moment.col(j)) - Vec3d(skeleton_.joints.col(j)).cross(Vec3d(force.col(j))) +
                         parent * (pose_feature_by_turn(model_.pose_feature, state_.rotation[j]).transpose() *
                                   sums.turn.col(j));
    by_numbers.segment<3>(3 + 3 * j) =
        axis_angle_chain(model_, skeleton_, axis_angle_.col(j), j).transpose() * torque;
    // Each bone's vertices hang on its own rest joint with minus, on the chain above with plus.
    by_joint.col(j) -= skeleton_.global[j].transpose() * sums.force.col(j);
    const Vec3d along = parent.transpose() * force.col(j);
    by_joint.col(j) += along;
    if (p >= 0) by_joint.col(p) -= along;
  }
  const Eigen::Map<const Eigen::VectorXf> flat(by_rest.data(), by_rest.size());
  const Eigen::VectorXf by_betas = model_.shapedirs.leftCols(betas_).transpose() * flat;
  by_numbers.tail(betas_) =
      by_betas.cast<double>() + model_.joint_shapedirs.leftCols(betas_).transpose() *
                                    Eigen::Map<const Eigen::VectorXd>(by_joint.data(), by_joint.size());
}

}  // namespace vitruvian
