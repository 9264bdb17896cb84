#include "detail/surface_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "core/geometry/solids.h"

namespace vitruvian {
namespace {

/// Flat square of side 1 m in the plane z = 0.
testing::Solid flat_square(int cells) {
  const int side = cells + 1;
  testing::Solid square{Points3f(3, side * side), Faces(3, 2 * cells * cells)};
  for (int i = 0; i < side * side; ++i) {
    square.vertices.col(i) =
        Vec3f(static_cast<float>(i % side), static_cast<float>(i / side), 0) / static_cast<float>(cells);
  }
  Index face = 0;
  for (int r = 0; r < cells; ++r) {
    for (int c = 0; c < cells; ++c) {
      const int a = r * side + c;
      square.faces.col(face++) << a, a + 1, a + side + 1;
      square.faces.col(face++) << a, a + side + 1, a + side;
    }
  }
  return square;
}

double energy(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& field) {
  return field.dot(matrix * field);
}

TEST(SurfaceEnergy, IsSymmetricAndPositiveDefinite) {
  const testing::Solid ball = testing::sphere(8, 12);
  const Eigen::MatrixXd matrix = SurfaceEnergy(ball.vertices, ball.faces).matrix({0.1});
  EXPECT_LT((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff(), 0);
}

TEST(SurfaceEnergy, OfAConstantIsTheSpringAlone) {
  const testing::Solid ball = testing::sphere(24, 36);
  const SurfaceEnergy surface(ball.vertices, ball.faces);
  const Smoothness s{0.2, 0.5, 2};
  const double spring = s.smoothing * s.smoothing / s.bridging / s.fading;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(ball.vertices.cols());
  EXPECT_NEAR(energy(surface.matrix(s), ones), spring * spring * surface.areas().sum(), 1e-12);
  EXPECT_NEAR(surface.areas().sum(), 4 * std::numbers::pi, 0.1);
}

// A spherical harmonic of degree l has laplacian -l (l + 1) on the unit sphere: all three terms are known.
TEST(SurfaceEnergy, AgreesWithSphericalHarmonics) {
  const testing::Solid ball = testing::sphere(60, 90);
  const SurfaceEnergy surface(ball.vertices, ball.faces);
  const Smoothness s{0.3, 0.4, 1.5};
  const double m = s.smoothing * s.smoothing / s.bridging, e = m / s.fading;
  const Eigen::VectorXd z = ball.vertices.row(2).cast<double>().transpose();
  const Eigen::VectorXd second = (3 * z.array().square() - 1) / 2;
  const auto expected = [&](int degree) {
    const double l = degree * (degree + 1), norm = 4 * std::numbers::pi / (2 * degree + 1);
    return norm * (std::pow(s.smoothing, 4) * l * l + m * m * l + e * e);
  };
  EXPECT_NEAR(energy(surface.matrix(s), z) / expected(1), 1, 0.02);
  EXPECT_NEAR(energy(surface.matrix(s), second) / expected(2), 1, 0.05) << "needles at the poles";
}

// Lengths are physical: the same field on a finer mesh has the same energy.
TEST(SurfaceEnergy, DoesNotDependOnTheMesh) {
  const auto of = [](int cells) {
    const testing::Solid square = flat_square(cells);
    const Eigen::VectorXd field =
        (std::numbers::pi * square.vertices.row(0).cast<double>().transpose().array()).cos();
    return energy(SurfaceEnergy(square.vertices, square.faces).matrix({0.2, 0.5, 1}), field);
  };
  EXPECT_NEAR(of(40) / of(20), 1, 0.02);
}

TEST(SurfaceEnergy, PatternIsTheSameForAllLengths) {
  const testing::Solid ball = testing::sphere(6, 9);
  const SurfaceEnergy surface(ball.vertices, ball.faces);
  const Eigen::SparseMatrix<double> one = surface.matrix({0.1}), other = surface.matrix({1e-5, 1, 10});
  ASSERT_EQ(one.nonZeros(), other.nonZeros());
  EXPECT_TRUE(std::equal(one.innerIndexPtr(), one.innerIndexPtr() + one.nonZeros(), other.innerIndexPtr()));
}

TEST(SurfaceEnergy, BearsFlatTrianglesAndLooseVertices) {
  Points3f vertices(3, 6);
  vertices << 0, 1, 2, 0, 5, 0,  //
      0, 0, 0, 1, 5, 0,          //
      0, 0, 0, 0, 5, 0;
  Faces faces(3, 3);
  faces << 0, 0, 0,  //
      1, 1, 5,       //
      2, 3, 3;
  const Eigen::MatrixXd matrix = SurfaceEnergy(vertices, faces).matrix({0.05});
  EXPECT_TRUE(matrix.allFinite());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff(), 0);
  EXPECT_GT(matrix(4, 4), 0);
}

}  // namespace
}  // namespace vitruvian
