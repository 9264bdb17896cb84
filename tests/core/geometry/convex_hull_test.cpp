#include "geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "base/error.h"
#include "core/geometry/solids.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

Mat3d random_turn(Random& random) {
  return Eigen::AngleAxisd(random.uniform(0, 3),
                           Vec3d(random.normal(), random.normal(), random.normal()).normalized())
      .toRotationMatrix();
}

/// A closed orientable surface: every directed edge once, its reverse once; Euler's formula.
void expect_sphere_topology(const ConvexHull& hull) {
  std::set<std::pair<int, int>> edges;
  std::set<int> corners;
  for (const auto& face : hull.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      corners.insert(face[k]);
      EXPECT_TRUE(edges.insert({face[k], face[(k + 1) % 3]}).second);
    }
  }
  for (const auto& [a, b] : edges) EXPECT_TRUE(edges.count({b, a}));
  EXPECT_EQ(corners.size() - edges.size() / 2 + hull.faces.size(), 2u);
}

TEST(ConvexHull, CubeWithPointsOnItsFacesEdgesAndInside) {
  Random random(5);
  Points3d points(3, 8 + 200);
  points.leftCols(8) = testing::unit_cube().vertices.cast<double>();
  for (Index i = 8; i < points.cols(); ++i) {
    for (int k = 0; k < 3; ++k) points(k, i) = random.below(5) / 4.0;
  }
  const ConvexHull hull = convex_hull(points);
  EXPECT_EQ(hull.defect, HullDefect::none);
  EXPECT_NEAR(hull.volume, 1, 1e-12);
  EXPECT_NEAR(hull.area, 6, 1e-12);
  expect_sphere_topology(hull);
}

TEST(ConvexHull, OfAConvexMeshIsTheMesh) {
  const testing::Solid ball = testing::sphere(40, 60);
  const ConvexHull hull = convex_hull(ball.vertices.cast<double>());
  EXPECT_NEAR(hull.volume, signed_volume(ball.vertices, ball.faces), 1e-6);
  expect_sphere_topology(hull);
}

TEST(ConvexHull, HoldsAllPointsWhateverTheScaleAndPlace) {
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const int count = 4 + static_cast<int>(random.below(300));
    Points3d points(3, count);
    // Thin, flat and round clouds, with duplicates.
    const Vec3d spread(1, std::pow(10, random.uniform(-3, 0)), std::pow(10, random.uniform(-3, 0)));
    for (int i = 0; i < count; ++i) {
      points.col(i) = i > 4 && random.below(4) == 0
                          ? Vec3d(points.col(random.below(static_cast<std::uint32_t>(i))))
                          : Vec3d(random.normal(), random.normal(), random.normal()).cwiseProduct(spread);
    }
    points = (random_turn(random) * points).eval();
    const ConvexHull hull = convex_hull(points);
    ASSERT_EQ(hull.defect, HullDefect::none);
    expect_sphere_topology(hull);
    for (const auto& face : hull.faces) {
      const Vec3d a = points.col(face[0]), b = points.col(face[1]), c = points.col(face[2]);
      const Vec3d normal = (b - a).cross(c - a);
      const double highest = (normal.transpose() * (points.colwise() - a)).maxCoeff();
      // The grid's step is 2^-24 of the extent, some 1e-7 here.
      EXPECT_LE(highest, 1e-6 * normal.norm());
    }
    const double scale = std::pow(10, random.uniform(-4, 4));
    const Points3d moved = (scale * points).colwise() + Vec3d(100 * scale, -7 * scale, 3 * scale);
    EXPECT_NEAR(convex_hull(moved).volume / (scale * scale * scale), hull.volume, 1e-5 * hull.area);
  }
}

TEST(ConvexHull, DegenerateSetsHaveAReason) {
  const auto defect_of = [](const Points3d& points) {
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.volume, 0);
    EXPECT_EQ(describe(hull.defect).empty(), hull.defect == HullDefect::none);
    return hull.defect;
  };
  EXPECT_EQ(defect_of(Points3d(3, 0)), HullDefect::too_few_points);
  EXPECT_EQ(defect_of(Points3d::Random(3, 3)), HullDefect::too_few_points);
  EXPECT_EQ(defect_of(Points3d::Constant(3, 9, 0.3)), HullDefect::coincident);
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    const Mat3d turn = random_turn(random);
    Points3d points = Points3d::Zero(3, 40);
    for (Index i = 0; i < 40; ++i) points(0, i) = random.normal();
    EXPECT_EQ(defect_of(turn * points), HullDefect::collinear);
    for (Index i = 0; i < 40; ++i) points(1, i) = random.normal();
    EXPECT_EQ(defect_of(turn * points), HullDefect::coplanar);
  }
  Points3d broken = Points3d::Random(3, 9);
  broken(1, 4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(convex_hull(broken), Error);
}

TEST(ConvexHull, InThePlane) {
  Points2d grid(2, 25);
  for (int i = 0; i < 25; ++i) grid.col(i) << i % 5, i / 5;
  const std::vector<int> hull = convex_hull_2d(grid);
  EXPECT_EQ(hull.size(), 4u) << "no collinear points";
  EXPECT_NEAR(polygon_area(grid(Eigen::all, hull)), 16, 1e-12);
  EXPECT_NEAR(polygon_perimeter(grid(Eigen::all, hull)), 16, 1e-12);
  EXPECT_EQ(convex_hull_2d(Points2d::Constant(2, 6, 1.5)).size(), 1u);
  Points2d line(2, 6);
  for (int i = 0; i < 6; ++i) line.col(i) << 0.25 * i, 0.5 * i;
  EXPECT_LT(convex_hull_2d(line).size(), 3u);
  EXPECT_TRUE(convex_hull_2d(Points2d(2, 0)).empty());
}

}  // namespace
}  // namespace vitruvian
