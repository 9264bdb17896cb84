#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "core/geometry/solids.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

constexpr int kNeighbours = 12;

/// Share of points whose normal is within acos(least_cosine) of the truth, sign included.
double share_right(const Points3f& normals, const Points3f& truth, float least_cosine) {
  return ((normals.array() * truth.array()).colwise().sum() > least_cosine).cast<double>().mean();
}

Points3f random_sphere(Random& random, Index count) {
  Points3f points(3, count);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] = static_cast<float>(random.normal());
  return points.colwise().normalized();
}

/// Uniform by area: places are kept with a chance that grows with the distance from the axis.
void random_torus(Random& random, double tube, Points3f& points, Points3f& normals) {
  for (Index i = 0; i < points.cols();) {
    const double u = random.uniform(), v = random.uniform();
    if (random.uniform() * (1 + tube) > 1 + tube * std::cos(2 * std::numbers::pi * v)) continue;
    points.col(i) = testing::torus_point(u, v, tube);
    const double a = 2 * std::numbers::pi * u;
    normals.col(i) = (points.col(i) - Vec3d(std::cos(a), std::sin(a), 0).cast<float>()).normalized();
    ++i;
  }
}

class PointCloudNormals : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(PointCloudNormals, OfASpherePointOutward) {
  Random random(GetParam());
  const Points3f points = random_sphere(random, 4000);
  // Anywhere: nothing may depend on the origin.
  const Points3f normals =
      point_cloud_normals(points.colwise() + Vec3f(30, -20, 5), kNeighbours, Execution(1));
  EXPECT_EQ(share_right(normals, points, 0.9f), 1);
  EXPECT_LT((normals.colwise().norm().array() - 1).abs().maxCoeff(), 1e-5f);
}

// The inner side of the ring faces the centre: only propagation can orient it.
TEST_P(PointCloudNormals, OfATorusPointOutward) {
  Random random(GetParam());
  Points3f points(3, 8000), truth(3, 8000);
  random_torus(random, 0.4, points, truth);
  EXPECT_EQ(share_right(point_cloud_normals(points, kNeighbours, Execution(1)), truth, 0), 1);
  EXPECT_GT(share_right(point_cloud_normals(points, kNeighbours, Execution(1)), truth, 0.9f), 0.995);
}

TEST_P(PointCloudNormals, SurviveNoise) {
  Random random(GetParam() + 50);
  Points3f points(3, 8000), truth(3, 8000);
  random_torus(random, 0.4, points, truth);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] += static_cast<float>(0.005 * random.normal());
  EXPECT_GT(share_right(point_cloud_normals(points, 20, Execution(1)), truth, 0.7f), 0.99);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PointCloudNormals, ::testing::Range(1u, 5u));

TEST(PointCloudNormalsThreads, GiveTheSameBytes) {
  Random random(9);
  const Points3f points = random_sphere(random, 3000);
  EXPECT_EQ(point_cloud_normals(points, kNeighbours, Execution(1)),
            point_cloud_normals(points, kNeighbours, Execution(2)));
}

TEST(PointCloudNormalsDegenerate, FewOrEqualPointsGiveFiniteNormals) {
  EXPECT_EQ(point_cloud_normals(Points3f(3, 0), kNeighbours, Execution(1)).cols(), 0);
  for (const Index count : {1, 2, 3, 100}) {
    const Points3f equal = Points3f::Constant(3, count, 4.0f);
    EXPECT_TRUE(point_cloud_normals(equal, kNeighbours, Execution(1)).allFinite()) << count;
  }
  Points3f line = Points3f::Zero(3, 50);
  for (Index i = 0; i < 50; ++i) line(0, i) = static_cast<float>(i);
  const Points3f normals = point_cloud_normals(line, kNeighbours, Execution(1));
  EXPECT_TRUE(normals.allFinite());
  EXPECT_LT(normals.row(0).cwiseAbs().maxCoeff(), 1e-3f);
}

}  // namespace
}  // namespace vitruvian
