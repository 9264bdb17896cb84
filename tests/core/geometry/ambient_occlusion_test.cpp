#include "geometry/ambient_occlusion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

struct Mesh {
  Points3f vertices;
  Faces faces;
};

/// Latitude-longitude sphere of radius 1, counter-clockwise from outside.
Mesh sphere(int rings, int sectors) {
  Mesh mesh;
  mesh.vertices.resize(3, (rings + 1) * sectors);
  mesh.faces.resize(3, 2 * rings * sectors);
  Index f = 0;
  for (int r = 0; r <= rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const double polar = std::numbers::pi * (r + 0.01) / (rings + 0.02),
                   angle = 2 * std::numbers::pi * s / sectors;
      mesh.vertices.col(r * sectors + s) =
          Vec3d(std::sin(polar) * std::cos(angle), std::cos(polar), -std::sin(polar) * std::sin(angle))
              .cast<float>();
      if (r == rings) continue;
      const int a = r * sectors + s, b = r * sectors + (s + 1) % sectors;
      mesh.faces.col(f++) << a, a + sectors, b + sectors;
      mesh.faces.col(f++) << a, b + sectors, b;
    }
  }
  return mesh;
}

Mesh joined(const Mesh& a, const Mesh& b) {
  Mesh both;
  both.vertices.resize(3, a.vertices.cols() + b.vertices.cols());
  both.vertices << a.vertices, b.vertices;
  both.faces.resize(3, a.faces.cols() + b.faces.cols());
  both.faces << a.faces, (b.faces.array() + static_cast<int>(a.vertices.cols())).matrix();
  return both;
}

std::vector<std::uint64_t> visibility_of(const Mesh& mesh, int threads = 1) {
  return sky_visibility(mesh.vertices, mesh.faces, {}, Execution(threads));
}

TEST(AmbientOcclusion, DirectionsAreEvenOppositeUnitVectors) {
  const Points3f sky = sky_directions();
  ASSERT_EQ(sky.cols(), kSkyDirections);
  for (int k = 0; k < kSkyDirections; ++k) EXPECT_NEAR(sky.col(k).norm(), 1, 1e-6);
  for (int k = 0; k < 32; ++k) EXPECT_EQ(Vec3f(sky.col(k)), Vec3f(-sky.col(k + 32)));
  const Mat3f moments = sky * sky.transpose() / kSkyDirections;
  EXPECT_LT((moments - Mat3f::Identity() / 3).norm(), 0.02);
}

TEST(AmbientOcclusion, ConvexBodySeesItsWholeHalf) {
  const Mesh mesh = sphere(60, 120);
  const auto visibility = visibility_of(mesh);
  const Eigen::VectorXf open = ambient_occlusion(visibility, mesh.vertices);
  EXPECT_GT(open.minCoeff(), 0.93f);
  const Points3f sky = sky_directions();
  for (Index i = 0; i < mesh.vertices.cols(); i += 7) {
    for (int k = 0; k < kSkyDirections; ++k) {
      const float cosine = sky.col(k).dot(mesh.vertices.col(i));
      if (cosine < -0.3f) EXPECT_FALSE(visibility[i] >> k & 1);
    }
  }
}

TEST(AmbientOcclusion, SphereInsideASphereSeesNothing) {
  Mesh inner = sphere(30, 60);
  inner.vertices *= 0.7f;
  const auto visibility = visibility_of(joined(sphere(60, 120), inner));
  for (std::size_t i = 61 * 120; i < visibility.size(); ++i) EXPECT_EQ(visibility[i], 0u);
}

TEST(AmbientOcclusion, AgreesWithRaysAgainstBallAndFloor) {
  Mesh floor;
  floor.vertices = (Points3f(3, 4) << -2, 2, 2, -2, -1.3f, -1.3f, -1.3f, -1.3f, 2, 2, -2, -2).finished();
  floor.faces = (Faces(3, 2) << 0, 0, 1, 2, 2, 3).finished();
  const Mesh ball = sphere(60, 120);
  const auto visibility = visibility_of(joined(ball, floor));
  const Points3f sky = sky_directions();
  int compared = 0, different = 0;
  for (Index i = 0; i < ball.vertices.cols(); ++i) {
    const Vec3f point = ball.vertices.col(i);
    for (int k = 0; k < kSkyDirections; ++k) {
      const Vec3f direction = sky.col(k);
      const float cosine = direction.dot(point);
      if (std::fabs(cosine) < 0.4f) continue;  // grazing rays depend on the depth test's slack
      const float t = (-1.3f - point.y()) / direction.y();
      const Vec3f hit = point + t * direction;
      const float edge = std::max(std::fabs(hit.x()), std::fabs(hit.z()));
      if (t > 0 && std::fabs(edge - 2) < 0.1f) continue;
      const bool open = cosine > 0 && !(t > 0 && edge < 2);
      ++compared;
      different += open != static_cast<bool>(visibility[i] >> k & 1);
    }
  }
  EXPECT_GT(compared, 100000);
  EXPECT_LT(different, compared / 200);
  EXPECT_LT(ambient_occlusion(visibility, joined(ball, floor).vertices)[ball.vertices.cols() - 1], 0.2f);
}

TEST(AmbientOcclusion, SameForAnyNumberOfThreads) {
  const Mesh mesh = joined(sphere(20, 40), sphere(15, 25));
  EXPECT_EQ(visibility_of(mesh, 1), visibility_of(mesh, 3));
}

TEST(AmbientOcclusion, CloudHidesWhatIsBehindIt) {
  const Mesh mesh = sphere(60, 120);
  const auto visibility = sky_visibility(
      mesh.vertices, Faces(3, 0), Eigen::VectorXf::Constant(mesh.vertices.cols(), 0.08f), Execution(1));
  const Eigen::VectorXf open = ambient_occlusion(visibility, mesh.vertices);
  EXPECT_GT(open.minCoeff(), 0.8f);
  const Points3f sky = sky_directions();
  for (Index i = 0; i < mesh.vertices.cols(); i += 11) {
    for (int k = 0; k < kSkyDirections; ++k) {
      if (sky.col(k).dot(mesh.vertices.col(i)) < -0.4f) EXPECT_FALSE(visibility[i] >> k & 1);
    }
  }
}

TEST(AmbientOcclusion, SurvivesDegenerateInput) {
  EXPECT_TRUE(sky_visibility(Points3f(3, 0), Faces(3, 0), {}, Execution(1)).empty());
  Points3f same = Points3f::Ones(3, 5);
  same(1, 3) = std::nanf("");
  const auto visibility = sky_visibility(same, Faces(3, 0), Eigen::VectorXf::Zero(5), Execution(1));
  EXPECT_EQ(visibility[3], 0u);
  EXPECT_EQ(visibility[0], ~std::uint64_t{0});
  Faces face(3, 1);
  face << 0, 3, 4;
  const Points3f normals = outward_normals(same, face, Points3f(3, 0), visibility);
  EXPECT_EQ(normals.norm(), 0);
}

class OutwardNormals : public testing::TestWithParam<std::string> {};

TEST_P(OutwardNormals, PointOutwardWhateverTheWinding) {
  // Two balls that touch: not convex, with a deep groove.
  Mesh right = sphere(40, 80);
  right.vertices.row(0).array() += 1.8f;
  Mesh mesh = joined(sphere(40, 80), right);
  const Points3f truth = vertex_normals(mesh.vertices, mesh.faces);
  Random random(3);
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    const bool turn = GetParam() == "inside-out" || (GetParam() == "mixed" && random.uniform() < 0.5);
    if (turn) std::swap(mesh.faces(0, f), mesh.faces(1, f));
  }
  const Points3f found = outward_normals(mesh.vertices, mesh.faces, Points3f(3, 0), visibility_of(mesh));
  int wrong = 0;
  for (Index i = 0; i < found.cols(); ++i) wrong += found.col(i).dot(truth.col(i)) < 0.9f;
  EXPECT_LT(wrong, GetParam() == "mixed" ? found.cols() / 50 : 1);
}

INSTANTIATE_TEST_SUITE_P(Windings, OutwardNormals, testing::Values("outward", "inside-out", "mixed"));

TEST(OutwardNormals, CloudsWithoutNormalsGetRoughOnes) {
  const Mesh mesh = sphere(50, 100);
  const auto visibility = sky_visibility(mesh.vertices, Faces(3, 0),
                                         Eigen::VectorXf::Constant(mesh.vertices.cols(), 0.1f), Execution(1));
  const Points3f none =
      outward_normals(mesh.vertices, Faces(3, 0), Points3f::Zero(3, mesh.vertices.cols()), visibility);
  const Points3f inward = outward_normals(mesh.vertices, Faces(3, 0), -mesh.vertices, visibility);
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    EXPECT_GT(none.col(i).dot(mesh.vertices.col(i)), 0.8f);
    EXPECT_GT(inward.col(i).dot(mesh.vertices.col(i)), 0.999f);
  }
}

}  // namespace
}  // namespace vitruvian
