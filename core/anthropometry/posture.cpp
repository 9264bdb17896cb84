#include "anthropometry/posture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace vitruvian {
namespace {

constexpr double kMostCollarFall = 15 * std::numbers::pi / 180;
/// Arms hang a little off the trunk.
constexpr double kSittingArmAngle = 8 * std::numbers::pi / 180;

Mat3d turn(double angle, const Vec3d& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

}  // namespace

BodyState standard_posture(const MeasuredModel& model, const Eigen::VectorXd& betas) {
  BodyState state = BodyState::rest(model.body());
  state.betas = betas;
  const Points3d joints = pose_skeleton(model.body(), state).rest_joints;
  const auto joint = [&](const char* segment) {
    return static_cast<std::size_t>(model.joint(segment_named(segment)));
  };
  const auto place = [&](std::size_t j) { return Vec3d(joints.col(static_cast<Index>(j))); };
  for (const bool left : {true, false}) {
    const double side = left ? 1 : -1;
    const std::size_t hip = joint(left ? "left_upper_leg" : "right_upper_leg"),
                      ankle = joint(left ? "left_foot" : "right_foot");
    // About the forward axis, so that knee and foot keep pointing ahead.
    const Vec3d leg = place(ankle) - place(hip);
    const double length = std::hypot(leg.x(), leg.y());
    const double wanted = std::clamp(kAnkleHalfDistance - side * place(hip).x(), -0.5 * length, 0.5 * length);
    const double now = std::atan2(side * leg.x(), -leg.y());
    const double swing = side * (std::asin(wanted / length) - now);
    state.rotation[hip] = turn(swing, Vec3d::UnitZ());
    state.rotation[ankle] = turn(-swing, Vec3d::UnitZ());

    const std::size_t collar = joint(left ? "left_shoulder" : "right_shoulder"),
                      shoulder = joint(left ? "left_arm" : "right_arm"),
                      elbow = joint(left ? "left_forearm" : "right_forearm");
    const Vec3d arm = (place(elbow) - place(shoulder)).normalized();
    const Vec3d hanging(side * std::sin(kArmAngle), -std::cos(kArmAngle), 0);
    const double fall = std::acos(std::clamp(arm.dot(hanging), -1.0, 1.0));
    const Mat3d collar_turn = turn(-side * std::min(kMostCollarFall, fall / 4), Vec3d::UnitZ());
    const Mat3d whole = Eigen::Quaterniond::FromTwoVectors(collar_turn * arm, hanging).toRotationMatrix();
    state.rotation[collar] = collar_turn;
    state.rotation[shoulder] = collar_turn.transpose() * whole * collar_turn;
  }
  return state;
}

BodyState seated_posture(const MeasuredModel& model, const Eigen::VectorXd& betas) {
  BodyState state = BodyState::rest(model.body());
  state.betas = betas;
  const Points3d joints = pose_skeleton(model.body(), state).rest_joints;
  const auto joint = [&](const std::string& segment) {
    return static_cast<std::size_t>(model.joint(segment_named(segment)));
  };
  const auto bone = [&](std::size_t from, std::size_t to) {
    return Vec3d((joints.col(static_cast<Index>(to)) - joints.col(static_cast<Index>(from))).normalized());
  };
  const auto toward = [](const Vec3d& from, const Vec3d& to) {
    return Mat3d(Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix());
  };
  for (const std::string side : {"left", "right"}) {
    const std::size_t hip = joint(side + "_upper_leg"), knee = joint(side + "_leg"),
                      ankle = joint(side + "_foot");
    const Mat3d thigh = toward(bone(hip, knee), Vec3d::UnitZ()),
                shank = toward(bone(knee, ankle), -Vec3d::UnitY());
    state.rotation[hip] = thigh;
    state.rotation[knee] = thigh.transpose() * shank;
    state.rotation[ankle] = shank.transpose();

    const double sign = side == "left" ? 1 : -1;
    const std::size_t collar = joint(side + "_shoulder"), shoulder = joint(side + "_arm"),
                      elbow = joint(side + "_forearm"), wrist = joint(side + "_hand");
    const Mat3d collar_turn = turn(-sign * kMostCollarFall, Vec3d::UnitZ());
    const Vec3d hanging(sign * std::sin(kSittingArmAngle), -std::cos(kSittingArmAngle), 0);
    const Mat3d upper = toward(collar_turn * bone(shoulder, elbow), hanging) * collar_turn;
    const Mat3d lower = toward(upper * bone(elbow, wrist), Vec3d::UnitZ()) * upper;
    state.rotation[collar] = collar_turn;
    state.rotation[shoulder] = collar_turn.transpose() * upper;
    state.rotation[elbow] = upper.transpose() * lower;
  }
  return state;
}

}  // namespace vitruvian
