#include "align/frame.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

constexpr int kNose = 0, kLeftEar = 7, kRightEar = 8, kLeftShoulder = 11, kRightShoulder = 12, kLeftHip = 23,
              kRightHip = 24;

/// Columns: principal directions, largest variance first, right-handed.
Mat3d principal_directions(const Points3f& points, const Vec3d& mean) {
  Mat3d covariance = Mat3d::Zero();
  for (Index i = 0; i < points.cols(); ++i) {
    const Vec3d d = points.col(i).cast<double>() - mean;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3d> solver(covariance / static_cast<double>(points.cols()));
  Mat3d directions;
  directions.col(0) = solver.eigenvectors().col(2);
  directions.col(1) = solver.eigenvectors().col(1);
  for (int k = 0; k < 2; ++k) {
    Index largest;
    directions.col(k).cwiseAbs().maxCoeff(&largest);
    if (directions(largest, k) < 0) directions.col(k) = -directions.col(k);
  }
  directions.col(2) = directions.col(0).cross(directions.col(1));
  return directions;
}

Vec3d mean_of(const Points3f& points) { return points.cast<double>().rowwise().mean(); }

double skewness(const Points3f& points, const Vec3d& mean, const Vec3d& direction) {
  double sum = 0;
  for (Index i = 0; i < points.cols(); ++i)
    sum += std::pow(direction.dot(points.col(i).cast<double>() - mean), 3);
  return sum;
}

}  // namespace

Mat3d body_from_scan_rotation(const Vec3d& up, const std::optional<Vec3d>& front) {
  if (!(up.norm() > 0) || !up.allFinite()) throw Error(ErrorCode::usage, "the up direction has no length");
  const Vec3d y = up.normalized();
  Vec3d forward;
  if (front) {
    forward = *front;
  } else {
    // Preferred order z, x, y; the margin keeps the choice stable for directions close to an axis.
    constexpr double kMargin = 0.1;
    forward = Vec3d::UnitZ();
    for (const Vec3d& axis : {Vec3d(Vec3d::UnitX()), Vec3d(Vec3d::UnitY())}) {
      if (std::fabs(axis.dot(y)) + kMargin < std::fabs(forward.dot(y))) forward = axis;
    }
  }
  Vec3d z = forward - forward.dot(y) * y;
  if (!(z.norm() > 1e-6 * forward.norm())) {
    throw Error(ErrorCode::usage,
                "the front direction is parallel to the up direction; choose another axis for one");
  }
  z.normalize();
  Mat3d rotation;
  rotation << y.cross(z).transpose(), y.transpose(), z.transpose();
  return rotation;
}

Mat4d body_from_scan(const Mat3d& rotation, const Vec3d& centroid_scan, double metres_per_unit) {
  Mat4d transform = Mat4d::Identity();
  transform.topLeftCorner<3, 3>() = metres_per_unit * rotation;
  transform.topRightCorner<3, 1>() = -metres_per_unit * (rotation * centroid_scan);
  return transform;
}

Mat4d facing_forward(const Mat4d& transform, double yaw) {
  Mat4d turn = Mat4d::Identity();
  turn.topLeftCorner<3, 3>() = Eigen::AngleAxisd(-yaw, Vec3d::UnitY()).toRotationMatrix();
  return turn * transform;
}

void turn_forward(std::vector<Landmark3d>& landmarks_body, double yaw) {
  const Mat3f turn = Eigen::AngleAxisd(-yaw, Vec3d::UnitY()).toRotationMatrix().cast<float>();
  for (Landmark3d& landmark : landmarks_body) landmark.position = turn * landmark.position;
}

std::optional<Facing> yaw_from_landmarks(std::span<const Landmark3d> landmarks) {
  if (landmarks.size() != kLandmarkCount) throw Error(ErrorCode::internal, "not 33 landmarks");
  const auto known = [&](int l) { return landmarks[l].confidence > 0 && landmarks[l].position.allFinite(); };
  const auto at = [&](int l) -> Vec3d { return landmarks[l].position.cast<double>(); };
  for (const int required : {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip}) {
    if (!known(required)) return std::nullopt;
  }
  const Vec3d shoulders = 0.5 * (at(kLeftShoulder) + at(kRightShoulder)),
              hips = 0.5 * (at(kLeftHip) + at(kRightHip));
  const Vec3d trunk = shoulders - hips;
  // The hips' landmarks err most, so the shoulders count double.
  const Vec3d lateral = 2 * (at(kLeftShoulder) - at(kRightShoulder)) + (at(kLeftHip) - at(kRightHip));
  const Vec3d chest = lateral.cross(trunk);
  if (!(chest.norm() > 1e-3 * lateral.norm()) || !(lateral.norm() > 1e-3)) return std::nullopt;
  const Vec3d facing = chest.normalized();

  Vec3d horizontal(facing.x(), 0, facing.z());
  constexpr double kLying = 0.35;
  if (horizontal.norm() < kLying) {
    const double fallen = facing.y() > 0 ? -1 : 1;
    horizontal += fallen * Vec3d(trunk.x(), 0, trunk.z()).normalized();
  }
  double confidence = 0;
  for (const int l : {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip})
    confidence += 0.25 * landmarks[l].confidence;
  const Vec3d across_shoulders = (at(kLeftShoulder) - at(kRightShoulder)).cross(trunk);
  const Vec3d across_hips = (at(kLeftHip) - at(kRightHip)).cross(trunk);
  if (across_shoulders.dot(across_hips) < 0) confidence *= 0.3;
  if (known(kNose) && known(kLeftEar) && known(kRightEar)) {
    const Vec3d gaze = at(kNose) - 0.5 * (at(kLeftEar) + at(kRightEar));
    if (gaze.dot(facing) < 0) confidence *= 0.3;
  }
  return Facing{std::atan2(horizontal.x(), horizontal.z()), std::clamp(confidence, 0.0, 1.0)};
}

std::string nearest_axis(const Vec3d& direction_scan) {
  static constexpr std::array<const char*, 6> kNames{"x", "y", "z", "-x", "-y", "-z"};
  Index axis;
  direction_scan.cwiseAbs().maxCoeff(&axis);
  return kNames[static_cast<std::size_t>(axis) + (direction_scan[axis] < 0 ? 3 : 0)];
}

Vec3d axis_vector(std::string_view name) {
  const bool negative = !name.empty() && name.front() == '-';
  const std::string_view letter = negative ? name.substr(1) : name;
  if (letter != "x" && letter != "y" && letter != "z") {
    throw Error(ErrorCode::usage, "\"" + std::string(name) + "\" is not an axis; use x, y, z, -x, -y or -z");
  }
  const Vec3d axis = Vec3d::Unit(letter.front() - 'x');
  return negative ? Vec3d(-axis) : axis;
}

Mat3d align_pca(const Points3f& scan_points, const Points3f& template_points) {
  if (scan_points.cols() < 4 || template_points.cols() < 4) {
    throw Error(ErrorCode::no_geometry, "too few points for a principal component analysis");
  }
  const Vec3d scan_mean = mean_of(scan_points), template_mean = mean_of(template_points);
  Mat3d scan_axes = principal_directions(scan_points, scan_mean);
  const Mat3d template_axes = principal_directions(template_points, template_mean);
  const double scan_skew = skewness(scan_points, scan_mean, scan_axes.col(2));
  const double template_skew = skewness(template_points, template_mean, template_axes.col(2));
  if (scan_skew * template_skew < 0) {
    scan_axes.col(1) = -scan_axes.col(1);
    scan_axes.col(2) = -scan_axes.col(2);
  }
  return template_axes * scan_axes.transpose();
}

}  // namespace vitruvian
