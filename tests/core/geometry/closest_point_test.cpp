#include "geometry/closest_point.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace vitruvian {
namespace {

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d ab = b - a;
  const double squared = ab.squaredNorm();
  const double t = squared > 0 ? std::clamp(ab.dot(p - a) / squared, 0.0, 1.0) : 0.0;
  return (a + t * ab - p).norm();
}

/// Distance to a triangle in double precision by another way than the code's: the plane where the foot lies
/// inside, else the nearest edge.
double distance_to_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double edges =
      std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  const Vec3d normal = (b - a).cross(c - a);
  if (normal.squaredNorm() <= 1e-24 * (b - a).squaredNorm() * (c - a).squaredNorm()) return edges;
  const auto inside = [&](const Vec3d& from, const Vec3d& to) {
    return (to - from).cross(p - from).dot(normal) >= 0;
  };
  if (!inside(a, b) || !inside(b, c) || !inside(c, a)) return edges;
  return std::min(edges, std::abs((p - a).dot(normal)) / normal.norm());
}

struct Soup {
  Points3f vertices;
  Faces faces;

  Vec3d corner(Index face, int k) const { return vertices.col(faces(k, face)).cast<double>(); }
  double distance(const Vec3f& p) const {
    double least = 1e300;
    for (Index f = 0; f < faces.cols(); ++f) {
      least =
          std::min(least, distance_to_triangle(p.cast<double>(), corner(f, 0), corner(f, 1), corner(f, 2)));
    }
    return least;
  }
};

/// Triangles of many sizes, among them ones that are points, segments and needles.
Soup random_soup(Random& random, int count) {
  Soup soup{Points3f(3, 3 * count), Faces(3, count)};
  const auto vector = [&](double scale) {
    return Vec3d(scale * random.normal(), scale * random.normal(), scale * random.normal());
  };
  for (int f = 0; f < count; ++f) {
    const Vec3d a = vector(1);
    const double size = std::pow(10, random.uniform(-5, 0));
    Vec3d b = a + vector(size), c = a + vector(size);
    switch (random.below(8)) {
      case 0:
        b = c = a;
        break;
      case 1:
        c = random.below(2) ? a : b;
        break;
      case 2:
        c = a + random.uniform(-1, 2) * (b - a);
        break;
      case 3:
        c = a + random.uniform(-1, 2) * (b - a) + vector(1e-4 * size);
        break;
      default:
        break;
    }
    const Vec3d corners[3] = {a, b, c};
    for (int k = 0; k < 3; ++k) {
      soup.vertices.col(3 * f + k) = corners[k].cast<float>();
      soup.faces(k, f) = 3 * f + k;
    }
  }
  return soup;
}

/// Somewhere, or right beside a triangle, or far away.
Vec3f random_query(Random& random, const Soup& soup) {
  const Vec3d noise(random.normal(), random.normal(), random.normal());
  switch (random.below(3)) {
    case 0: {
      const Index f = random.below(static_cast<std::uint32_t>(soup.faces.cols()));
      const double u = random.uniform(), v = random.uniform() * (1 - u);
      const Vec3d on = (1 - u - v) * soup.corner(f, 0) + u * soup.corner(f, 1) + v * soup.corner(f, 2);
      return (on + std::pow(10, random.uniform(-6, -1)) * noise).cast<float>();
    }
    case 1:
      return (50 * noise).cast<float>();
    default:
      return noise.cast<float>();
  }
}

class ClosestPointTest : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(ClosestPointTest, AgreesWithBruteForceOnNastySoups) {
  Random random(GetParam());
  const Soup soup = random_soup(random, static_cast<int>(1 + random.below(250)));
  const ClosestPointOnMesh mesh(soup.vertices, soup.faces);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3f query = random_query(random, soup);
    const SurfacePoint found = mesh.query(query);
    const double truth = soup.distance(query);
    // Float coordinates of size |x| leave 6e-8 |x|, needles make more of it.
    const double tolerance = 1e-5 * (1 + query.norm());
    ASSERT_TRUE(found.face >= 0 && found.face < soup.faces.cols());
    EXPECT_NEAR(found.distance, truth, tolerance) << "query " << query.transpose();
    EXPECT_NEAR((found.position - query).norm(), found.distance, tolerance);
    Vec3d rebuilt = Vec3d::Zero();
    for (int k = 0; k < 3; ++k) rebuilt += found.barycentric[k] * soup.corner(found.face, k);
    EXPECT_LT((rebuilt - found.position.cast<double>()).norm(), 4e-6);
    EXPECT_NEAR(found.barycentric.sum(), 1, 1e-5);
    EXPECT_GE(found.barycentric.minCoeff(), -1e-6f);
  }
}

TEST_P(ClosestPointTest, TheLimitOnlyHidesWhatLiesBeyondIt) {
  Random random(GetParam() + 100);
  const Soup soup = random_soup(random, 100);
  const ClosestPointOnMesh mesh(soup.vertices, soup.faces);
  int found_any = 0, gave_up = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3f query = random_query(random, soup);
    const SurfacePoint free = mesh.query(query);
    const float limit = static_cast<float>(random.uniform(0.1, 2)) * free.distance;
    if (std::abs(limit - free.distance) <= 1e-5f * free.distance) continue;
    const SurfacePoint limited = mesh.query(query, limit);
    if (limit > free.distance) {
      ++found_any;
      EXPECT_EQ(limited.face, free.face);
      EXPECT_EQ(limited.distance, free.distance);
    } else {
      ++gave_up;
      EXPECT_EQ(limited.face, -1);
      EXPECT_EQ(limited.distance, limit);
    }
  }
  EXPECT_GT(found_any, 20);
  EXPECT_GT(gave_up, 20);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ClosestPointTest, ::testing::Range(1u, 21u));

TEST(ClosestPoint, FindsEachOfTheSevenRegionsOfATriangle) {
  Soup soup{Points3f(3, 3), Faces(3, 1)};
  soup.vertices << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  soup.faces << 0, 1, 2;
  const ClosestPointOnMesh mesh(soup.vertices, soup.faces);
  const std::pair<Vec3f, Vec3f> query_and_foot[] = {
      {{-1, -1, 1}, {0, 0, 0}},          {{2, -0.5f, 1}, {1, 0, 0}},    {{-0.5f, 2, 1}, {0, 1, 0}},
      {{0.3f, -2, 1}, {0.3f, 0, 0}},     {{-2, 0.4f, 1}, {0, 0.4f, 0}}, {{1, 1, 1}, {0.5f, 0.5f, 0}},
      {{0.2f, 0.3f, 1}, {0.2f, 0.3f, 0}}};
  for (const auto& [query, foot] : query_and_foot) {
    EXPECT_LT((mesh.query(query).position - foot).norm(), 1e-6f) << query.transpose();
  }
}

TEST(ClosestPoint, AMeshWithoutFacesHasNoClosestPoint) {
  const ClosestPointOnMesh mesh(Points3f::Random(3, 10), Faces(3, 0));
  const SurfacePoint found = mesh.query(Vec3f::Zero(), 5);
  EXPECT_EQ(found.face, -1);
  EXPECT_EQ(found.distance, 5);
}

TEST(ClosestPoint, ManyEqualTrianglesAreNoTrap) {
  Points3f vertices(3, 3);
  vertices << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  Faces faces(3, 5000);
  faces.colwise() = Eigen::Vector3i(0, 1, 2);
  const ClosestPointOnMesh mesh(vertices, faces);
  EXPECT_FLOAT_EQ(mesh.query(Vec3f(0.2f, 0.2f, 3)).distance, 3);
}

}  // namespace
}  // namespace vitruvian
