#include "geometry/plane_section.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/solids.h"
#include "geometry/mass_properties.h"

namespace vitruvian {
namespace {

using std::numbers::pi;

/// A truncated cone along Z from radius r0 at 0 to r1 at `height`: closed n-gonal prism with lids.
struct Cone {
  Points3d vertices;
  Faces faces;
  Cone(int n, double r0, double r1, double height) : vertices(3, 2 * n + 2), faces(3, 4 * n) {
    for (int i = 0; i < n; ++i) {
      const double a = 2 * pi * i / n;
      vertices.col(i) << r0 * std::cos(a), r0 * std::sin(a), 0;
      vertices.col(n + i) << r1 * std::cos(a), r1 * std::sin(a), height;
      const int j = (i + 1) % n;
      faces.col(4 * i) << i, j, n + j;
      faces.col(4 * i + 1) << i, n + j, n + i;
      faces.col(4 * i + 2) << j, i, 2 * n;
      faces.col(4 * i + 3) << n + i, n + j, 2 * n + 1;
    }
    vertices.col(2 * n).setZero();
    vertices.col(2 * n + 1) << 0, 0, height;
  }
};

TEST(PlaneSection, ConeAndCylinderToTheLastDigit) {
  const int n = 256;
  const double polygon_area_factor = n / 2.0 * std::sin(2 * pi / n), polygon_side = 2 * std::sin(pi / n);
  for (const double r1 : {0.1, 0.25}) {
    const Cone cone(n, 0.1, r1, 0.7);
    for (const double z : {0.0123, 0.35, 0.69}) {
      const double r = 0.1 + (r1 - 0.1) * z / 0.7;
      const auto loops = plane_section(cone.vertices, cone.faces, {Vec3d(0, 0, z), Vec3d::UnitZ()});
      ASSERT_EQ(loops.size(), 1u);
      EXPECT_TRUE(loops[0].closed);
      const SectionMeasure m = measure_section(loops[0], Vec3d::UnitX(), Vec3d::UnitY());
      // Half of the corners lie on the diagonals of the side quads, a hair inside of the n-gon when it
      // tapers.
      EXPECT_NEAR(m.hull_area, polygon_area_factor * r * r, 1e-12 + (r1 > 0.1 ? 2e-6 : 0));
      EXPECT_NEAR(m.hull_perimeter, n * polygon_side * r, 1e-12 + (r1 > 0.1 ? 1e-5 : 0));
      EXPECT_NEAR(m.perimeter, 2 * pi * r, 2e-4 * r);
      EXPECT_NEAR(m.breadth, 2 * r, 1e-9 + (r1 > 0.1 ? 1e-5 : 0));
      EXPECT_NEAR(m.depth, 2 * r, 1e-4 * r);
      EXPECT_GT(polygon_area(project_section(loops[0], Vec3d::UnitX(), Vec3d::UnitY())), 0)
          << "counter-clockwise seen from where the normal points to";
    }
    const double a0 = polygon_area_factor * 0.01, a1 = polygon_area_factor * r1 * r1;
    EXPECT_NEAR(mass_properties(cone.vertices, cone.faces).volume, 0.7 / 3 * (a0 + a1 + std::sqrt(a0 * a1)),
                1e-12);
  }
}

TEST(PlaneSection, EllipsoidTiltedPlane) {
  const testing::Solid ball = testing::sphere(300, 600);
  const Vec3d axes(0.3, 0.2, 0.5);
  const Points3d vertices = axes.asDiagonal() * ball.vertices.cast<double>();
  // Through the centre, normal in the XZ plane: an ellipse with half axes 0.2 and that of the XZ ellipse
  // across.
  const double tilt = 0.6;
  const Vec3d normal(std::sin(tilt), 0, std::cos(tilt)), across(std::cos(tilt), 0, -std::sin(tilt));
  const double half = 1 / std::sqrt(std::pow(across.x() / 0.3, 2) + std::pow(across.z() / 0.5, 2));
  const auto loops = plane_section(vertices, ball.faces, {Vec3d::Zero(), normal});
  ASSERT_EQ(loops.size(), 1u);
  const SectionMeasure m = measure_section(loops[0], across, Vec3d::UnitY());
  EXPECT_NEAR(m.area, pi * half * 0.2, 2e-5);
  EXPECT_NEAR(m.breadth, 2 * half, 2e-5);
  EXPECT_NEAR(m.depth, 0.4, 2e-5);
  const double h = std::pow((half - 0.2) / (half + 0.2), 2);
  EXPECT_NEAR(m.perimeter, pi * (half + 0.2) * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h))), 3e-5)
      << "Ramanujan";
}

TEST(PlaneSection, TwoCurvesOfATorusAndThePlaneThroughItsVertices) {
  const testing::Solid ring = testing::torus(90, 60, 0.25);
  const Points3d vertices = ring.vertices.cast<double>();
  for (const double y : {0.0, 0.1}) {
    const auto loops = plane_section(vertices, ring.faces, {Vec3d(0, y, 0), Vec3d::UnitY()});
    ASSERT_EQ(loops.size(), 2u);
    for (const SectionLoop& loop : loops) {
      EXPECT_TRUE(loop.closed);
      EXPECT_EQ(loop.points.size(), loop.face.size());
      const SectionMeasure m = measure_section(loop, Vec3d::UnitX(), Vec3d::UnitZ());
      EXPECT_NEAR(m.depth, 0.5, 0.005);
      EXPECT_NEAR(m.area, pi * 0.0625, 0.01);
    }
  }
  // Level with the ring: outer curve and hole, which turns the other way.
  const auto loops = plane_section(vertices, ring.faces, {Vec3d::Zero(), Vec3d::UnitZ()});
  ASSERT_EQ(loops.size(), 2u);
  double area = 0;
  for (const SectionLoop& loop : loops) {
    area += polygon_area(project_section(loop, Vec3d::UnitX(), Vec3d::UnitY()));
  }
  EXPECT_NEAR(area, pi * (1.25 * 1.25 - 0.75 * 0.75), 0.02);
  EXPECT_TRUE(plane_section(vertices, ring.faces, {Vec3d(0, 0, 3), Vec3d::UnitZ()}).empty());
}

TEST(PlaneSection, PointsFollowTheMesh) {
  const testing::Solid ball = testing::sphere(20, 30);
  const Points3d vertices = ball.vertices.cast<double>();
  const auto loops = plane_section(vertices, ball.faces, {Vec3d(0, 0, 0.2), Vec3d(0.6, 0, 0.8)});
  ASSERT_EQ(loops.size(), 1u);
  for (const SectionPoint& p : loops[0].points) {
    EXPECT_NEAR((p.position - (1 - p.along) * vertices.col(p.from) - p.along * vertices.col(p.to)).norm(), 0,
                1e-15);
    EXPECT_NEAR(Vec3d(0.6, 0, 0.8).dot(p.position - Vec3d(0, 0, 0.2)), 0, 1e-12);
  }
}

TEST(PlaneSection, HoleLeavesAnOpenCurve) {
  const testing::Solid cube = testing::unit_cube();
  const Faces open = cube.faces.rightCols(10);
  // The bottom is missing: the curve runs from its edge up and down again.
  const auto loops = plane_section(cube.vertices.cast<double>(), open, {Vec3d(0.4, 0, 0), Vec3d::UnitX()});
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_FALSE(loops[0].closed);
  EXPECT_EQ(loops[0].points.size(), loops[0].face.size() + 1);
  EXPECT_NEAR(measure_section(loops[0], Vec3d::UnitY(), Vec3d::UnitZ()).area, 1, 1e-12);
}

TEST(MassProperties, BoxAnywhere) {
  const testing::Solid cube = testing::unit_cube();
  const Vec3d size(0.3, 0.5, 0.7), place(12, -5, 3);
  Mat3d turn = Eigen::AngleAxisd(0.7, Vec3d(1, 2, -1).normalized()).toRotationMatrix();
  const Points3d vertices =
      (turn * (size.asDiagonal() * (cube.vertices.cast<double>().array() - 0.5).matrix())).colwise() + place;
  const MassProperties m = mass_properties(vertices, cube.faces);
  const double volume = size.prod();
  EXPECT_NEAR(m.volume, volume, 1e-14);
  EXPECT_LT((m.centroid - place).norm(), 1e-13);
  const Vec3d squares = size.cwiseAbs2();
  const Mat3d inertia =
      volume / 12 *
      Vec3d(squares.sum() - squares.x(), squares.sum() - squares.y(), squares.sum() - squares.z())
          .asDiagonal();
  EXPECT_LT((m.inertia - turn * inertia * turn.transpose()).norm(), 1e-14);
  EXPECT_NEAR(surface_area(vertices, cube.faces), 2 * (0.15 + 0.21 + 0.35), 1e-13);
}

TEST(MassProperties, Ellipsoid) {
  const testing::Solid ball = testing::sphere(200, 400);
  const Vec3d axes(0.3, 0.2, 0.5);
  const MassProperties m = mass_properties(axes.asDiagonal() * ball.vertices.cast<double>(), ball.faces);
  const double volume = 4 * pi / 3 * axes.prod();
  EXPECT_NEAR(m.volume / volume, 1, 2e-4);
  EXPECT_NEAR(m.inertia(2, 2) / (volume / 5 * (0.09 + 0.04)), 1, 4e-4);
}

}  // namespace
}  // namespace vitruvian
