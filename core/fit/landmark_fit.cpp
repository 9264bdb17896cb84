#include "fit/landmark_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace vitruvian {
namespace {

double torso_weight(const LandmarkTarget& landmark) {
  switch (landmark.joint) {
    case 1:
    case 2:
    case 16:
    case 17:
      return landmark.weight;
    case 15:
      return 0.3 * landmark.weight;
    default:
      return 0;
  }
}

constexpr double kLandmarksOfUnitSum = 17;  // keeps the weights comparable when landmarks are missing

}  // namespace

void place_by_torso(const FitModel& model, std::span<const LandmarkTarget> landmarks, BodyState& state) {
  const auto centre = [&](const Skeleton& skeleton, Vec3d& ours, Vec3d& theirs) {
    double total = 0;
    ours.setZero();
    theirs.setZero();
    for (const LandmarkTarget& l : landmarks) {
      const double w = torso_weight(l);
      if (!(w > 0)) continue;
      ours += w * landmark_position(skeleton, l);
      theirs += w * l.target;
      total += w;
    }
    if (total > 0) ours /= total, theirs /= total;
    return total > 0;
  };
  Skeleton skeleton = pose_skeleton(model.body, state);
  Vec3d ours, theirs;
  if (!centre(skeleton, ours, theirs)) return;
  Mat3d covariance = Mat3d::Zero();
  for (const LandmarkTarget& l : landmarks) {
    if (!(torso_weight(l) > 0)) continue;
    covariance += torso_weight(l) * (l.target - theirs) * (landmark_position(skeleton, l) - ours).transpose();
  }
  const Eigen::JacobiSVD<Mat3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3d sign = Mat3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign(2, 2) = -1;
  state.rotation[0] = svd.matrixU() * sign * svd.matrixV().transpose() * state.rotation[0];
  skeleton = pose_skeleton(model.body, state);
  centre(skeleton, ours, theirs);
  state.translation += theirs - ours;
}

double landmark_error(const Skeleton& skeleton, std::span<const LandmarkTarget> landmarks) {
  double sum = 0, weights = 0;
  for (const LandmarkTarget& l : landmarks) {
    if (!(l.weight > 0)) continue;
    sum += l.weight * (landmark_position(skeleton, l) - l.target).norm();
    weights += l.weight;
  }
  return weights > 0 ? sum / weights : 0;
}

BodyState fit_landmarks(const FitModel& model, std::span<const LandmarkTarget> landmarks,
                        const LandmarkFitSettings& settings, const FitObserver& each) {
  const int joints = model.body.joint_count();
  Points3d pose = Points3d::Zero(3, joints);
  if (model.prior.mean.size() == 3 * (joints - 1)) {
    pose.rightCols(joints - 1) = Eigen::Map<const Points3d>(model.prior.mean.data(), 3, joints - 1);
  }
  BodyState state = BodyState::from_axis_angle(pose, model.shape_prior.mean, Vec3d::Zero());
  place_by_torso(model, landmarks, state);
  NormalEquations equations(model);
  PosedModel posed;
  posed.rest = model.body.v_template;
  for (int i = 0; i < settings.iterations; ++i) {
    posed.skeleton = pose_skeleton(model.body, state);
    const BodyJacobian<float> jacobian(model.body, model.groups, state, posed.skeleton, posed.rest);
    const double scale = i < settings.iterations / 2 ? 4 * settings.scale : settings.scale;
    const double gaussian = i < settings.iterations / 3 ? 4 * settings.gaussian : settings.gaussian;
    if (each) {
      const double share = static_cast<double>(landmarks.size()) / kLandmarksOfUnitSum;
      each({-1,
            scale,
            state,
            posed.skeleton,
            nullptr,
            {},
            {},
            landmarks,
            scale,
            share,
            gaussian,
            settings.limits,
            settings.shape});
    }
    equations.clear();
    for (const LandmarkTarget& l : landmarks) {
      const double squared =
          (landmark_position(posed.skeleton, l) - l.target).squaredNorm() / (scale * scale);
      equations.add(jacobian, posed, l, 1 / (kLandmarksOfUnitSum * scale * scale * (1 + squared / 4)));
    }
    equations.add_pose_prior(state, posed, gaussian, settings.limits);
    equations.add_shape_prior(state, settings.shape);
    equations.step(posed, 1e-3, 0.5, state);
  }
  return state;
}

}  // namespace vitruvian
