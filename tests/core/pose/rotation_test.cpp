#include "pose/rotation.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "base/random.h"
#include "core/numeric_jacobian.h"

namespace vitruvian {
namespace {

using testing::expect_jacobian;

/// Rotation vectors at the angles where formulas break, about coordinate axes, diagonals and random ones.
std::vector<Eigen::Vector3d> nasty_vectors(double largest) {
  constexpr double kPi = std::numbers::pi;
  std::vector<Eigen::Vector3d> axes = {Eigen::Vector3d::UnitX(),
                                       -Eigen::Vector3d::UnitX(),
                                       Eigen::Vector3d::UnitY(),
                                       -Eigen::Vector3d::UnitZ(),
                                       Eigen::Vector3d(1, 1, 1).normalized(),
                                       Eigen::Vector3d(-1, 0, 1).normalized(),
                                       Eigen::Vector3d(1, 1e-9, -1e-9).normalized()};
  Random random(11);
  for (int k = 0; k < 20; ++k) {
    axes.push_back(Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized());
  }
  std::vector<Eigen::Vector3d> vectors = {Eigen::Vector3d::Zero()};
  for (const double angle :
       {1e-200, 1e-30, 1e-12, 1e-8, 1e-5, 1e-3, 0.05, 0.499999, 0.500001, 1.0, 2.0, 3.0, kPi - 1e-3,
        kPi - 1e-5, kPi - 1e-8, kPi - 1e-12, kPi, kPi + 0.5, 2 * kPi - 0.5}) {
    if (angle > largest) continue;
    for (const auto& axis : axes) vectors.push_back(angle * axis);
  }
  return vectors;
}

template <typename Scalar>
class RotationOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(RotationOf, Scalars);

TYPED_TEST(RotationOf, VectorGivesTheRotationOfEigen) {
  const TypeParam tolerance = 8 * std::numeric_limits<TypeParam>::epsilon();
  for (const auto& v : nasty_vectors(7)) {
    const double angle = v.norm();
    const Eigen::Matrix3d truth =
        angle > 0 ? Eigen::AngleAxisd(angle, v / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
    const Matrix3<TypeParam> got = rotation_from_vector<TypeParam>(v.cast<TypeParam>());
    EXPECT_LT((got.template cast<double>() - truth).norm(), tolerance) << v.transpose();
  }
}

TYPED_TEST(RotationOf, LogarithmUndoesExponential) {
  const double tolerance = 20 * static_cast<double>(std::numeric_limits<TypeParam>::epsilon());
  for (const auto& v : nasty_vectors(std::numbers::pi)) {
    const Vector3<TypeParam> start = v.cast<TypeParam>();
    const Vector3<TypeParam> back = vector_from_rotation<TypeParam>(rotation_from_vector<TypeParam>(start));
    // At a half turn both signs are right.
    const double distance =
        std::min((back - start).norm(), v.norm() > 3.14 ? (back + start).norm() : TypeParam(1e9));
    EXPECT_LT(distance, tolerance * std::max(1.0, v.norm())) << v.transpose();
  }
}

TYPED_TEST(RotationOf, LogarithmKeepsTheRelativeAccuracyOfSmallTurns) {
  const TypeParam tolerance = 20 * std::numeric_limits<TypeParam>::epsilon();
  for (const TypeParam angle : {TypeParam(1e-12), TypeParam(1e-6), TypeParam(1e-3)}) {
    const Vector3<TypeParam> start = angle * Vector3<TypeParam>(1, -2, 2) / 3;
    const Vector3<TypeParam> back = vector_from_rotation<TypeParam>(rotation_from_vector<TypeParam>(start));
    EXPECT_LT((back - start).norm(), tolerance * angle);
  }
}

TYPED_TEST(RotationOf, InverseJacobiansAreInverses) {
  const double epsilon = std::numeric_limits<TypeParam>::epsilon();
  for (const auto& v : nasty_vectors(6)) {
    const Vector3<TypeParam> s = v.cast<TypeParam>();
    const Matrix3<TypeParam> inverse = left_jacobian_inverse(s);
    const double tolerance = 20 * epsilon * inverse.norm();
    EXPECT_LT((left_jacobian(s) * inverse - Matrix3<TypeParam>::Identity()).norm(), tolerance)
        << v.transpose();
    EXPECT_LT((right_jacobian(s) * right_jacobian_inverse(s) - Matrix3<TypeParam>::Identity()).norm(),
              tolerance);
  }
}

TYPED_TEST(RotationOf, JacobiansAgreeWithDouble) {
  const double epsilon = std::numeric_limits<TypeParam>::epsilon();
  for (const auto& v : nasty_vectors(5)) {
    // The float input itself, so that only the formulas' rounding counts.
    const Vector3<TypeParam> s = v.cast<TypeParam>();
    const Eigen::Vector3d exact = s.template cast<double>();
    EXPECT_LT((left_jacobian(s).template cast<double>() - left_jacobian(exact)).norm(), 20 * epsilon)
        << v.transpose();
    EXPECT_LT((left_jacobian_inverse(s).template cast<double>() - left_jacobian_inverse(exact)).norm(),
              100 * epsilon);
  }
}

TEST(Rotation, LeftAndRightJacobiansMatchDifferences) {
  for (const auto& v : nasty_vectors(3.0)) {
    const Eigen::Matrix3d rotation = rotation_from_vector(v);
    expect_jacobian(
        left_jacobian(v), 3,
        [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
          return vector_from_rotation<double>(rotation_from_vector<double>(v + d) * rotation.transpose());
        },
        1e-5, 1e-8);
    expect_jacobian(
        right_jacobian(v), 3,
        [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
          return vector_from_rotation<double>(rotation.transpose() * rotation_from_vector<double>(v + d));
        },
        1e-5, 1e-8);
    expect_jacobian(
        left_jacobian_inverse(v), 3,
        [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
          return vector_from_rotation<double>(rotation_from_vector<double>(d) * rotation);
        },
        1e-5, 1e-8);
  }
}

TEST(Rotation, DerivativesOfTheMatrixMatchDifferences) {
  const Eigen::Vector3d point(0.3, -1.2, 0.7);
  for (const auto& v : nasty_vectors(6)) {
    expect_jacobian(
        rotation_by_vector(v), 3,
        [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
          const Eigen::Matrix3d transposed = rotation_from_vector<double>(v + d).transpose();
          return Eigen::Map<const Eigen::VectorXd>(transposed.data(), 9);
        },
        1e-5, 1e-8);
    expect_jacobian(
        rotated_point_by_vector(v, point), 3,
        [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
          return rotation_from_vector<double>(v + d) * point;
        },
        1e-5, 1e-8);
  }
}

TEST(Rotation, NearestRotationUndoesNoiseAndNeverMirrors) {
  Random random(5);
  for (int k = 0; k < 200; ++k) {
    Eigen::Matrix3d matrix;
    for (Eigen::Index i = 0; i < 9; ++i) matrix.data()[i] = random.normal();
    const Eigen::Matrix3d r = nearest_rotation(matrix);
    EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(r.determinant(), 1, 1e-12);
    // No small turn of it comes nearer.
    for (int axis = 0; axis < 6; ++axis) {
      const Eigen::Vector3d turn = (axis < 3 ? 1e-3 : -1e-3) * Eigen::Vector3d::Unit(axis % 3);
      EXPECT_GE((rotation_from_vector(turn) * r - matrix).norm(), (r - matrix).norm() - 1e-12)
          << "seed 5, case " << k;
    }
  }
}

}  // namespace
}  // namespace vitruvian
