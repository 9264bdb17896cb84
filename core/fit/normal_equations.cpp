#include "fit/normal_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <mutex>

namespace vitruvian {
namespace {

constexpr int kBlockRows = 384;
constexpr double kLimitScale = 0.1;  // rad
constexpr double kLargestBeta = 5;

/// Correspondences of one group that are multiplied together.
struct Block {
  int group;
  std::vector<int> members;
};

std::vector<Block> blocks_of(const AncestorGroups& groups, std::span<const Correspondence> correspondences) {
  std::vector<std::vector<int>> by_group(groups.joints.size());
  for (std::size_t i = 0; i < correspondences.size(); ++i) {
    if (correspondences[i].weight > 1e-6f) {
      by_group[groups.group_of_vertex[correspondences[i].vertex]].push_back(static_cast<int>(i));
    }
  }
  std::vector<Block> blocks;
  for (std::size_t g = 0; g < by_group.size(); ++g) {
    for (std::size_t begin = 0; begin < by_group[g].size(); begin += kBlockRows / 3) {
      const std::size_t end = std::min(by_group[g].size(), begin + kBlockRows / 3);
      blocks.push_back({static_cast<int>(g), {by_group[g].begin() + begin, by_group[g].begin() + end}});
    }
  }
  return blocks;
}

struct Sum {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
};

/// Storage reused from block to block.
struct Workspace {
  BodyJacobian<float>::Compact vertex;
  Eigen::MatrixXf columns;  // unknowns x rows
  Eigen::VectorXf residuals;
  Eigen::MatrixXf hessian;
  Eigen::VectorXf gradient;
};

[[gnu::noinline]] void accumulate(const FitModel& model, const BodyJacobian<float>& jacobian,
                                  std::span<const Correspondence> correspondences, const Block& block,
                                  Workspace& work, Sum& sum) {
  const int size = jacobian.compact_size(block.group);
  work.vertex.resize(3, size);
  work.columns.resize(size, kBlockRows);
  work.residuals.resize(kBlockRows);
  int rows = 0;
  for (const int i : block.members) {
    const Correspondence& c = correspondences[i];
    jacobian.vertex(c.vertex, work.vertex);
    const auto put = [&](const Vec3f& direction, float weight) {
      const float root = std::sqrt(weight);
      work.columns.col(rows).noalias() = work.vertex.transpose() * (root * direction);
      work.residuals[rows++] = root * direction.dot(c.error);
    };
    put(c.normal, c.weight * (1 + c.isotropy));
    if (c.isotropy > 0) {
      const Vec3f helper = std::abs(c.normal[0]) < 0.6f ? Vec3f::UnitX() : Vec3f::UnitY();
      const Vec3f tangent = c.normal.cross(helper).normalized();
      put(tangent, c.weight * c.isotropy);
      put(c.normal.cross(tangent), c.weight * c.isotropy);
    }
  }
  const auto used = work.columns.leftCols(rows);
  work.hessian.setZero(size, size);
  work.hessian.selfadjointView<Eigen::Lower>().rankUpdate(used);
  work.gradient.noalias() = used * work.residuals.head(rows);
  const std::vector<int>& joints = model.groups.joints[block.group];
  std::vector<int> target(size);
  for (int d = 0; d < 3; ++d) target[d] = d;
  for (std::size_t n = 0; n < joints.size(); ++n) {
    for (int d = 0; d < 3; ++d) target[3 + 3 * n + d] = 3 + 3 * joints[n] + d;
  }
  for (int k = 0; k < model.betas; ++k) {
    target[size - model.betas + k] = 3 + 3 * model.body.joint_count() + k;
  }
  for (int column = 0; column < size; ++column) {
    sum.gradient[target[column]] += work.gradient[column];
    for (int row = column; row < size; ++row) {
      sum.hessian(target[row], target[column]) += work.hessian(row, column);
    }
  }
}

}  // namespace

NormalEquations::NormalEquations(const FitModel& model) : model_(model) { clear(); }

void NormalEquations::clear() {
  hessian_.setZero(model_.unknowns(), model_.unknowns());
  gradient_.setZero(model_.unknowns());
}

void NormalEquations::add(const BodyJacobian<float>& jacobian,
                          std::span<const Correspondence> correspondences, double scale,
                          const Execution& execution) {
  const std::vector<Block> blocks = blocks_of(model_.groups, correspondences);
  std::map<std::ptrdiff_t, Sum> sums;  // by first block: added up in order, whatever thread was first
  std::mutex mutex;
  execution.parallel_for(static_cast<std::ptrdiff_t>(blocks.size()), 4,
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           Sum sum{Eigen::MatrixXd::Zero(model_.unknowns(), model_.unknowns()),
                                   Eigen::VectorXd::Zero(model_.unknowns())};
                           Workspace work;
                           for (std::ptrdiff_t b = begin; b < end; ++b)
                             accumulate(model_, jacobian, correspondences, blocks[b], work, sum);
                           const std::lock_guard<std::mutex> lock(mutex);
                           sums.emplace(begin, std::move(sum));
                         });
  for (const auto& [begin, sum] : sums) {
    hessian_ += scale * sum.hessian;
    gradient_ += scale * sum.gradient;
  }
}

Vec3d landmark_position(const Skeleton& skeleton, const LandmarkTarget& landmark) {
  return skeleton.joints.col(landmark.joint) + skeleton.global[landmark.frame_joint] * landmark.offset;
}

void NormalEquations::add(const BodyJacobian<float>& jacobian, const PosedModel& posed,
                          const LandmarkTarget& landmark, double scale) {
  const double weight = scale * landmark.weight;
  if (!(weight > 0)) return;
  Eigen::MatrixXd derivative = jacobian.full_joint(landmark.joint);
  const Vec3d arm = posed.skeleton.global[landmark.frame_joint] * landmark.offset;
  Mat3d cross;
  cross << 0, -arm[2], arm[1], arm[2], 0, -arm[0], -arm[1], arm[0], 0;
  for (int j = landmark.frame_joint; j >= 0; j = model_.body.parent[j])
    derivative.middleCols<3>(3 + 3 * j) -= cross;
  const Vec3d error = posed.skeleton.joints.col(landmark.joint) + arm - landmark.target;
  hessian_.selfadjointView<Eigen::Lower>().rankUpdate(derivative.transpose(), weight);
  gradient_.noalias() += weight * derivative.transpose() * error;
}

void NormalEquations::add_pose_prior(const BodyState& state, const PosedModel& posed, double gaussian,
                                     double limits) {
  const int joints = model_.body.joint_count();
  const Points3d pose = state.axis_angle();
  const int numbers = 3 * (joints - 1);
  if (numbers != model_.prior.mean.size())
    return;                                 // a prior for another skeleton says nothing about this one
  std::vector<Mat3d> by_increment(joints);  // d theta_j / d w_j
  for (int j = 1; j < joints; ++j) {
    by_increment[j] = axis_angle_chain(model_.body, posed.skeleton, pose.col(j), j).inverse();
  }
  const Eigen::Map<const Eigen::VectorXd> theta(pose.data() + 3, numbers);
  if (gaussian > 0) {
    const double c = gaussian / PosePrior::kSize;
    const Eigen::VectorXd pull = model_.prior.precision * (theta - model_.prior.mean);
    for (int a = 1; a < joints; ++a) {
      gradient_.segment<3>(3 + 3 * a) += c * by_increment[a].transpose() * pull.segment<3>(3 * (a - 1));
      for (int b = 1; b <= a; ++b) {
        hessian_.block<3, 3>(3 + 3 * a, 3 + 3 * b) +=
            c * by_increment[a].transpose() * model_.prior.precision.block<3, 3>(3 * (a - 1), 3 * (b - 1)) *
            by_increment[b];
      }
    }
  }
  if (limits > 0) {
    const double c = limits / PosePrior::kSize / (kLimitScale * kLimitScale);
    for (int i = 0; i < numbers; ++i) {
      const double excess = theta[i] < model_.prior.limit_low[i]    ? theta[i] - model_.prior.limit_low[i]
                            : theta[i] > model_.prior.limit_high[i] ? theta[i] - model_.prior.limit_high[i]
                                                                    : 0;
      if (excess == 0) continue;
      const int joint = 1 + i / 3;
      const Eigen::RowVector3d row = by_increment[joint].row(i % 3);
      hessian_.block<3, 3>(3 + 3 * joint, 3 + 3 * joint) += c * row.transpose() * row;
      gradient_.segment<3>(3 + 3 * joint) += c * excess * row.transpose();
    }
  }
}

void NormalEquations::add_shape_prior(const BodyState& state, double scale) {
  const double c = scale / std::max(1, model_.betas);
  hessian_.bottomRightCorner(model_.betas, model_.betas) += c * model_.shape_prior.precision;
  gradient_.tail(model_.betas) += c * model_.shape_prior.precision * (state.betas - model_.shape_prior.mean);
}

void NormalEquations::hold_joint(int joint, double scale) {
  for (int d = 0; d < 3; ++d) hessian_(3 + 3 * joint + d, 3 + 3 * joint + d) += scale;
}

void NormalEquations::step(const PosedModel& posed, double damping, double largest_rotation,
                           BodyState& state) const {
  Eigen::MatrixXd system = hessian_;
  system.diagonal() += damping * hessian_.diagonal();
  system.diagonal().array() += 1e-6;
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> cholesky(system);
  if (cholesky.info() != Eigen::Success) return;
  Eigen::VectorXd update = cholesky.solve(-gradient_);
  if (!update.allFinite()) return;
  for (int j = 0; j < model_.body.joint_count(); ++j) {
    const double angle = update.segment<3>(3 + 3 * j).norm();
    if (angle > largest_rotation) update.segment<3>(3 + 3 * j) *= largest_rotation / angle;
  }
  apply_update(model_.body, posed.skeleton, update, state);
  state.betas = state.betas.cwiseMax(-kLargestBeta).cwiseMin(kLargestBeta);
}

}  // namespace vitruvian
