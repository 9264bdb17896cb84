#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace vitruvian {

// The group of rotations and its derivatives (Sola, Deray, Atchuthan 2018, "A micro Lie theory", appendix B).
// A rotation vector v is the axis times the angle in radians; all functions are accurate from angle 0 to a
// half turn, the forward ones beyond.

template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
template <typename Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

/// Matrix of the cross product: skew(v) x = v x x.
template <typename Scalar>
Matrix3<Scalar> skew(const Vector3<Scalar>& v) {
  Matrix3<Scalar> m;
  m << Scalar(0), -v.z(), v.y(), v.z(), Scalar(0), -v.x(), -v.y(), v.x(), Scalar(0);
  return m;
}

namespace rotation_detail {

/// Below this squared angle the closed forms of the higher coefficients lose digits and their series are
/// used; the first term left out is then below double precision.
template <typename Scalar>
constexpr Scalar kSeriesBelow = Scalar(0.25);

/// sin(x) / x.
template <typename Scalar>
Scalar sinc(Scalar x) {
  return x == Scalar(0) ? Scalar(1) : std::sin(x) / x;
}

/// (1 - cos a) / a^2, written so that it does not cancel.
template <typename Scalar>
Scalar cosine_coefficient(Scalar angle) {
  const Scalar half = sinc(angle / 2);
  return half * half / 2;
}

/// (a - sin a) / a^3.
template <typename Scalar>
Scalar sine_coefficient(Scalar angle) {
  const Scalar s = angle * angle;
  if (s < kSeriesBelow<Scalar>) {
    return Scalar(1.0 / 6) -
           s * (Scalar(1.0 / 120) -
                s * (Scalar(1.0 / 5040) - s * (Scalar(1.0 / 362880) - s * (Scalar(1.0 / 39916800) -
                                                                           s * Scalar(1.0 / 6227020800.0)))));
  }
  return (angle - std::sin(angle)) / (s * angle);
}

/// (1 - (a/2) cot(a/2)) / a^2; finite at a half turn, infinite at a full one.
template <typename Scalar>
Scalar inverse_coefficient(Scalar angle) {
  const Scalar s = angle * angle;
  if (s < kSeriesBelow<Scalar>) {
    return Scalar(1.0 / 12) +
           s * (Scalar(1.0 / 720) +
                s * (Scalar(1.0 / 30240) +
                     s * (Scalar(1.0 / 1209600) +
                          s * (Scalar(1.0 / 47900160) + s * Scalar(691.0 / 1307674368000.0)))));
  }
  const Scalar half = angle / 2;
  return (Scalar(1) - half * std::cos(half) / std::sin(half)) / s;
}

}  // namespace rotation_detail

/// Rotation matrix of a rotation vector (Rodrigues' formula).
template <typename Scalar>
Matrix3<Scalar> rotation_from_vector(const Vector3<Scalar>& v) {
  const Scalar angle = v.norm();
  const Matrix3<Scalar> k = skew(v);
  return Matrix3<Scalar>::Identity() + rotation_detail::sinc(angle) * k +
         rotation_detail::cosine_coefficient(angle) * (k * k);
}

/// Rotation vector of a rotation matrix, angle in [0, pi]. Of the two answers at a half turn one is picked.
template <typename Scalar>
Vector3<Scalar> vector_from_rotation(const Matrix3<Scalar>& rotation) {
  // By way of the unit quaternion (cos a/2, n sin a/2): unlike the trace it stays accurate near 0 and near
  // pi.
  Eigen::Quaternion<Scalar> q(rotation);
  q.normalize();
  if (q.w() < Scalar(0)) q.coeffs() = -q.coeffs();
  const Scalar sine = q.vec().norm();
  const Scalar scale = sine > Scalar(0) ? 2 * std::atan2(sine, q.w()) / sine : Scalar(2);
  return scale * q.vec();
}

/// J with exp(v + d) = exp(J d) exp(v) to first order in d.
template <typename Scalar>
Matrix3<Scalar> left_jacobian(const Vector3<Scalar>& v) {
  const Scalar angle = v.norm();
  const Matrix3<Scalar> k = skew(v);
  return Matrix3<Scalar>::Identity() + rotation_detail::cosine_coefficient(angle) * k +
         rotation_detail::sine_coefficient(angle) * (k * k);
}

/// Inverse of left_jacobian: log(exp(d) exp(v)) = v + left_jacobian_inverse(v) d to first order. Angle below
/// 2 pi.
template <typename Scalar>
Matrix3<Scalar> left_jacobian_inverse(const Vector3<Scalar>& v) {
  const Matrix3<Scalar> k = skew(v);
  return Matrix3<Scalar>::Identity() - k / 2 + rotation_detail::inverse_coefficient(v.norm()) * (k * k);
}

/// J with exp(v + d) = exp(v) exp(J d) to first order in d.
template <typename Scalar>
Matrix3<Scalar> right_jacobian(const Vector3<Scalar>& v) {
  return left_jacobian(v).transpose();
}

/// Inverse of right_jacobian: log(exp(v) exp(d)) = v + right_jacobian_inverse(v) d to first order. Angle
/// below 2 pi.
template <typename Scalar>
Matrix3<Scalar> right_jacobian_inverse(const Vector3<Scalar>& v) {
  return left_jacobian_inverse(v).transpose();
}

/// d (rotation_from_vector(v) p) / d v.
template <typename Scalar>
Matrix3<Scalar> rotated_point_by_vector(const Vector3<Scalar>& v, const Vector3<Scalar>& p) {
  const Vector3<Scalar> rotated = rotation_from_vector(v) * p;
  return -skew(rotated) * left_jacobian(v);
}

/// d vec(rotation_from_vector(v)) / d v; rows: the matrix row by row, as in SMPL's pose correctives.
template <typename Scalar>
Eigen::Matrix<Scalar, 9, 3> rotation_by_vector(const Vector3<Scalar>& v) {
  const Matrix3<Scalar> rotation = rotation_from_vector(v);
  const Matrix3<Scalar> jacobian = left_jacobian(v);
  Eigen::Matrix<Scalar, 9, 3> derivative;
  for (int k = 0; k < 3; ++k) {
    const Vector3<Scalar> turn = jacobian.col(k);
    const Matrix3<Scalar> change = skew(turn) * rotation;
    for (int row = 0; row < 3; ++row) {
      derivative.template block<3, 1>(3 * row, k) = change.row(row).transpose();
    }
  }
  return derivative;
}

/// Rotation closest to a matrix in the sum of squares of the differences (orthogonal Procrustes).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace vitruvian
