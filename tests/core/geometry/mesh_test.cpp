#include "geometry/mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "core/geometry/solids.h"
#include "geometry/closest_point.h"

namespace vitruvian {
namespace {

using testing::Solid;

constexpr double kPi = std::numbers::pi;

/// Chi-square statistic of `count` draws from cells with these shares.
double chi_square(const std::vector<double>& shares, const std::vector<int>& drawn, int count) {
  double sum = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double expected = shares[i] * count;
    sum += (drawn[i] - expected) * (drawn[i] - expected) / expected;
  }
  return sum;
}

Vec3f triangle_normal(const Points3f& vertices, const Faces& faces, Index f) {
  const Vec3f a = vertices.col(faces(0, f));
  return (vertices.col(faces(1, f)) - a).cross(vertices.col(faces(2, f)) - a);
}

TEST(Mesh, NormalsOfASphereAreItsPoints) {
  const Solid sphere = testing::sphere(40, 80);
  const Points3f normals = vertex_normals(sphere.vertices, sphere.faces);
  EXPECT_LT((normals - sphere.vertices).colwise().norm().maxCoeff(), 0.02f);
  EXPECT_LT((normals.colwise().norm().array() - 1).abs().maxCoeff(), 1e-6f);
}

TEST(Mesh, NormalsOfACubePointAwayFromItsMiddle) {
  const Solid cube = testing::unit_cube();
  const Points3f normals = vertex_normals(cube.vertices, cube.faces);
  for (Index i = 0; i < 8; ++i) {
    const Vec3f outward = 2 * (cube.vertices.col(i) - Vec3f::Constant(0.5f));
    for (int k = 0; k < 3; ++k) EXPECT_GT(normals(k, i) * outward[k], 0.2f);
  }
}

TEST(Mesh, NormalsDoNotDependOnTheSizeOfTheUnit) {
  const Solid sphere = testing::sphere(12, 24);
  const Points3f expected = vertex_normals(sphere.vertices, sphere.faces);
  for (const float scale : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
    const Points3f normals = vertex_normals(scale * sphere.vertices, sphere.faces);
    EXPECT_LT((normals - expected).cwiseAbs().maxCoeff(), 1e-5f) << scale;
  }
}

TEST(Mesh, AVertexWithoutAreaHasNoNormal) {
  Points3f vertices = Points3f::Zero(3, 5);
  vertices.col(1) = Vec3f::UnitX();
  Faces faces(3, 2);
  faces << 0, 2, 1, 3, 1, 1;  // a segment there and back, and a point
  const Points3f normals = vertex_normals(vertices, faces);
  EXPECT_EQ(normals.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(vertex_areas(vertices, faces).maxCoeff(), 0);
}

TEST(Mesh, AreasAndVolumeOfKnownSolids) {
  const Solid cube = testing::unit_cube();
  EXPECT_NEAR(vertex_areas(cube.vertices, cube.faces).sum(), 6, 1e-6);
  EXPECT_NEAR(signed_volume(cube.vertices, cube.faces), 1, 1e-9);
  const Solid sphere = testing::sphere(100, 200);
  EXPECT_NEAR(vertex_areas(sphere.vertices, sphere.faces).sum(), 4 * kPi, 0.01);
  EXPECT_NEAR(signed_volume(sphere.vertices, sphere.faces), 4 * kPi / 3, 0.005);
  const Solid torus = testing::torus(120, 60, 0.3);
  EXPECT_NEAR(vertex_areas(torus.vertices, torus.faces).sum(), 4 * kPi * kPi * 0.3, 0.03);
  EXPECT_NEAR(signed_volume(torus.vertices, torus.faces), 2 * kPi * kPi * 0.09, 0.01);
}

TEST(Mesh, VolumeTurnsItsSignWithTheWindingAndStaysUnderMotion) {
  const Solid torus = testing::torus(60, 30, 0.4);
  const double volume = signed_volume(torus.vertices, torus.faces);
  EXPECT_NEAR(signed_volume(torus.vertices, torus.faces.colwise().reverse()), -volume, 1e-9);
  const Mat3f turn = Eigen::AngleAxisf(1.2f, Vec3f(1, -2, 0.5f).normalized()).toRotationMatrix();
  const Points3f moved = (turn * torus.vertices).colwise() + Vec3f(3, -4, 5);
  EXPECT_NEAR(signed_volume(moved, torus.faces), volume, 2e-4);
}

class SamplingTest : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(SamplingTest, EachTriangleGetsItsShareOfThePoints) {
  constexpr int kCount = 20000;
  const Solid torus = testing::torus(40, 20, 0.6);
  const Points3f normals = vertex_normals(torus.vertices, torus.faces);
  const SurfaceSamples samples = sample_surface(torus.vertices, torus.faces, normals, kCount, GetParam());
  std::vector<double> shares(torus.faces.cols());
  double total = 0;
  for (Index f = 0; f < torus.faces.cols(); ++f) {
    total += shares[f] = triangle_normal(torus.vertices, torus.faces, f).norm();
  }
  for (double& share : shares) share /= total;
  std::vector<int> drawn(shares.size(), 0);
  for (const int f : samples.source) ++drawn[f];
  // Independent draws would give the number of triangles (1600) on average; stratified ones far less.
  EXPECT_LT(chi_square(shares, drawn, kCount), 800);
}

TEST_P(SamplingTest, PointsFillATriangleEvenly) {
  constexpr int kCount = 16000;
  Points3f vertices(3, 3);
  vertices << 0, 2, 0.5f, 0, 0, 1, 0, 0, 0;
  Faces faces(3, 1);
  faces << 0, 1, 2;
  const SurfaceSamples samples =
      sample_surface(vertices, faces, vertex_normals(vertices, faces), kCount, GetParam());
  // Sixteen equal triangles in barycentric coordinates.
  std::vector<int> drawn(16, 0);
  Mat3f corners;
  corners << vertices.row(0), vertices.row(1), Eigen::RowVector3f::Ones();
  for (Index i = 0; i < kCount; ++i) {
    const Vec3f weights = corners.inverse() * Vec3f(samples.points(0, i), samples.points(1, i), 1);
    ASSERT_GE(weights.minCoeff(), -1e-5f);
    const int row = std::clamp(static_cast<int>(4 * weights[1]), 0, 3),
              column = std::clamp(static_cast<int>(4 * weights[2]), 0, 3 - row);
    const bool upper = 4 * weights[1] - row + 4 * weights[2] - column > 1 && column < 3 - row;
    int cell = 0;
    for (int r = 0; r < row; ++r) cell += 2 * (3 - r) + 1;
    ++drawn[cell + 2 * column + (upper ? 1 : 0)];
  }
  // 15 degrees of freedom: beyond 45 by chance in one of 10,000.
  EXPECT_LT(chi_square(std::vector<double>(16, 1.0 / 16), drawn, kCount), 45);
}

TEST_P(SamplingTest, PointsLieOnTheirTrianglesWithUnitNormals) {
  const Solid sphere = testing::sphere(20, 40);
  const Points3f normals = vertex_normals(sphere.vertices, sphere.faces);
  const SurfaceSamples samples = sample_surface(sphere.vertices, sphere.faces, normals, 500, GetParam());
  for (Index i = 0; i < 500; ++i) {
    Faces one = sphere.faces.col(samples.source[i]);
    EXPECT_LT(ClosestPointOnMesh(sphere.vertices, one).query(samples.points.col(i)).distance, 1e-6f);
    EXPECT_NEAR(samples.normals.col(i).norm(), 1, 1e-5);
    EXPECT_GT(samples.normals.col(i).dot(samples.points.col(i).normalized()), 0.98f);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SamplingTest, ::testing::Values(1u, 2u, 3u, 4294967295u));

TEST(Sampling, SameSeedSameBytesOtherSeedOtherPoints) {
  const Solid cube = testing::unit_cube();
  const Points3f normals = vertex_normals(cube.vertices, cube.faces);
  const auto sample = [&](std::uint32_t seed) {
    return sample_surface(cube.vertices, cube.faces, normals, 300, seed);
  };
  EXPECT_EQ(sample(5).points, sample(5).points);
  EXPECT_EQ(sample(5).normals, sample(5).normals);
  EXPECT_NE(sample(5).points, sample(6).points);
}

TEST(Sampling, CloudsGiveEachPointOnceWhenThereAreEnough) {
  const Points3f cloud = Points3f::Random(3, 1000);
  const SurfaceSamples thinned = sample_surface(cloud, Faces(3, 0), cloud, 250, 3);
  std::vector<int> sources = thinned.source;
  std::sort(sources.begin(), sources.end());
  EXPECT_TRUE(std::adjacent_find(sources.begin(), sources.end()) == sources.end());
  for (Index i = 0; i < 250; ++i) EXPECT_EQ(thinned.points.col(i), cloud.col(thinned.source[i]));
  const SurfaceSamples all = sample_surface(cloud, Faces(3, 0), cloud, 5000, 3);
  std::vector<int> times(1000, 0);
  for (const int s : all.source) ++times[s];
  EXPECT_GE(*std::min_element(times.begin(), times.end()), 3);
  EXPECT_LE(*std::max_element(times.begin(), times.end()), 7);
}

TEST(Sampling, ASurfaceWithoutAreaGivesPointsOfIt) {
  const Points3f vertices = Points3f::Constant(3, 6, 2.5f);
  Faces faces(3, 2);
  faces << 0, 3, 1, 4, 2, 5;
  const SurfaceSamples samples = sample_surface(vertices, faces, Points3f::Zero(3, 6), 10, 1);
  EXPECT_LT((samples.points.array() - 2.5f).abs().maxCoeff(), 1e-6f);
}

TEST(Decimation, KeepsBoundsOrientationAndVolume) {
  const Solid torus = testing::torus(300, 150, 0.4);
  const Points3f normals = vertex_normals(torus.vertices, torus.faces);
  for (const int target : {500, 2000, 10000}) {
    SCOPED_TRACE(target);
    const DecimatedMesh coarse = cluster_decimate(torus.vertices, normals, torus.faces, target);
    EXPECT_GT(coarse.vertices.cols(), 0.6 * target);
    EXPECT_LT(coarse.vertices.cols(), 1.6 * target);
    for (int k = 0; k < 3; ++k) {
      const float low = torus.vertices.row(k).minCoeff(), high = torus.vertices.row(k).maxCoeff();
      const float cell = 3 / std::sqrt(static_cast<float>(target));
      EXPECT_GE(coarse.vertices.row(k).minCoeff(), low - 1e-5f);
      EXPECT_LE(coarse.vertices.row(k).maxCoeff(), high + 1e-5f);
      EXPECT_LT(coarse.vertices.row(k).minCoeff(), low + cell);
      EXPECT_GT(coarse.vertices.row(k).maxCoeff(), high - cell);
    }
    const double volume = 2 * kPi * kPi * 0.16;
    EXPECT_NEAR(signed_volume(coarse.vertices, coarse.faces), volume, 0.15 * volume);
    EXPECT_LT((coarse.normals.colwise().norm().array() - 1).abs().maxCoeff(), 1e-5f);
    int with = 0;
    for (Index f = 0; f < coarse.faces.cols(); ++f) {
      ASSERT_GE(coarse.faces.col(f).minCoeff(), 0);
      ASSERT_LT(coarse.faces.col(f).maxCoeff(), coarse.vertices.cols());
      with +=
          triangle_normal(coarse.vertices, coarse.faces, f).dot(coarse.normals.col(coarse.faces(0, f))) > 0;
    }
    EXPECT_GT(with, 0.97 * static_cast<double>(coarse.faces.cols()));
    ASSERT_EQ(coarse.source.size(), static_cast<std::size_t>(coarse.vertices.cols()));
    for (Index i = 0; i < coarse.vertices.cols(); ++i) {
      EXPECT_LT((torus.vertices.col(coarse.source[i]) - coarse.vertices.col(i)).norm(),
                6 / std::sqrt(static_cast<float>(target)));
    }
  }
}

TEST(Decimation, SmallMeshesStayAsTheyAre) {
  const Solid cube = testing::unit_cube();
  const Points3f normals = vertex_normals(cube.vertices, cube.faces);
  const DecimatedMesh same = cluster_decimate(cube.vertices, normals, cube.faces, 8);
  EXPECT_EQ(same.vertices, cube.vertices);
  EXPECT_EQ(same.faces, cube.faces);
  EXPECT_EQ(same.source, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Decimation, CloudsAreThinned) {
  Random random(11);
  Points3f cloud(3, 20000);
  for (Index i = 0; i < cloud.cols(); ++i) {
    cloud.col(i) = testing::torus_point(random.uniform(), random.uniform(), 0.3);
  }
  const DecimatedMesh thin = cluster_decimate(cloud, Points3f::Zero(3, cloud.cols()), Faces(3, 0), 1000);
  EXPECT_EQ(thin.faces.cols(), 0);
  EXPECT_GT(thin.vertices.cols(), 600);
  EXPECT_LT(thin.vertices.cols(), 1600);
}

TEST(Decimation, EqualPointsBecomeOne) {
  const Points3f vertices = Points3f::Constant(3, 100, -7.25f);
  Faces faces(3, 50);
  for (int f = 0; f < 50; ++f) faces.col(f) << f, f + 1, f + 2;
  const DecimatedMesh one = cluster_decimate(vertices, Points3f::Zero(3, 100), faces, 10);
  ASSERT_EQ(one.vertices.cols(), 1);
  EXPECT_EQ(one.vertices.col(0), Vec3f::Constant(-7.25f));
  EXPECT_EQ(one.faces.cols(), 0);
}

TEST(Decimation, PointsOnALineOrInAPlaneAreThinnedToo) {
  Random random(3);
  Points3f line = Points3f::Zero(3, 5000), plane = Points3f::Zero(3, 5000);
  for (Index i = 0; i < 5000; ++i) {
    line(1, i) = static_cast<float>(random.uniform(0, 3));
    plane(0, i) = static_cast<float>(random.uniform(0, 3));
    plane(2, i) = static_cast<float>(random.uniform(-1, 1));
  }
  for (const Points3f& points : {line, plane}) {
    const DecimatedMesh thin = cluster_decimate(points, Points3f::Zero(3, 5000), Faces(3, 0), 400);
    EXPECT_GT(thin.vertices.cols(), 100);
    EXPECT_LT(thin.vertices.cols(), 1200);
    EXPECT_TRUE(thin.vertices.allFinite());
  }
}

// A far stray makes the cells large against the body; points of different cells must never be averaged.
TEST(Decimation, AFarStrayDoesNotMixDistantPoints) {
  for (const float far : {1e2f, 1e4f, 1e6f, 1e8f}) {
    SCOPED_TRACE(far);
    const Solid sphere = testing::sphere(60, 120);
    Points3f vertices(3, sphere.vertices.cols() + 2);
    vertices << sphere.vertices, Vec3f(far, 0, 0), Vec3f(0, -far, far);
    const DecimatedMesh coarse =
        cluster_decimate(vertices, Points3f::Zero(3, vertices.cols()), sphere.faces, 1000);
    for (Index i = 0; i < coarse.vertices.cols(); ++i) {
      const float from_source = (vertices.col(coarse.source[i]) - coarse.vertices.col(i)).norm();
      EXPECT_LE(from_source, 2.1f + 1e-5f * far);
    }
  }
}

}  // namespace
}  // namespace vitruvian
