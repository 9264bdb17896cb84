#include "measure/inside.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "geometry/mesh.h"

namespace vitruvian {
namespace {

struct Surface {
  Points3f vertices;
  Faces faces;
};

/// A closed ball of 30 rings.
Surface ball(const Vec3f& centre, float radius) {
  constexpr int kRings = 30, kAround = 60;
  Surface s;
  s.vertices.resize(3, kRings * kAround + 2);
  s.faces.resize(3, 2 * kRings * kAround);
  const auto at = [&](int ring, int k) {
    return ring < 0 ? kRings * kAround : ring >= kRings ? kRings * kAround + 1 : ring * kAround + k % kAround;
  };
  const float pi = std::numbers::pi_v<float>;
  for (int r = 0; r < kRings; ++r) {
    const float theta = pi * (static_cast<float>(r) + 1) / (kRings + 1);
    for (int k = 0; k < kAround; ++k) {
      const float phi = 2 * pi * static_cast<float>(k) / kAround;
      s.vertices.col(at(r, k)) = centre + radius * Vec3f(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                         -std::sin(theta) * std::sin(phi));
    }
  }
  s.vertices.col(at(-1, 0)) = centre + radius * Vec3f::UnitY();
  s.vertices.col(at(kRings, 0)) = centre - radius * Vec3f::UnitY();
  Index f = 0;
  for (int k = 0; k < kAround; ++k) {
    s.faces.col(f++) << at(-1, 0), at(0, k), at(0, k + 1);
    s.faces.col(f++) << at(kRings, 0), at(kRings - 1, k + 1), at(kRings - 1, k);
    for (int r = 0; r + 1 < kRings; ++r) {
      s.faces.col(f++) << at(r, k), at(r + 1, k), at(r, k + 1);
      s.faces.col(f++) << at(r, k + 1), at(r + 1, k), at(r + 1, k + 1);
    }
  }
  return s;
}

double share_of(const Surface& s) {
  return inside_share(s.vertices, vertex_normals(s.vertices, s.faces), s.faces);
}

Surface joined(const Surface& a, const Surface& b) {
  Surface s;
  s.vertices.resize(3, a.vertices.cols() + b.vertices.cols());
  s.vertices << a.vertices, b.vertices;
  s.faces.resize(3, a.faces.cols() + b.faces.cols());
  s.faces << a.faces, (b.faces.array() + static_cast<int>(a.vertices.cols())).matrix();
  return s;
}

TEST(InsideShare, IsNoneForAPlainBallAndForTwoApart) {
  const Surface one = ball(Vec3f(0.1f, -0.2f, 0.3f), 0.5f);
  EXPECT_EQ(share_of(one), 0);
  EXPECT_EQ(share_of(joined(one, ball(Vec3f(2, 0, 0), 0.5f))), 0);
}

TEST(InsideShare, IsTheCapsOfTwoBallsThatPenetrate) {
  // Each loses a cap of height r - d / 2 of its 2 r, less what lies shallower than 5 mm.
  const double expected = (0.5 - 0.3) / (2 * 0.5);
  for (const Vec3f& way : {Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0.36f, 0.48f, 0.8f)}) {
    const Surface both = joined(ball(Vec3f::Zero(), 0.5f), ball(0.6f * way, 0.5f));
    EXPECT_NEAR(share_of(both), expected, 0.015);
  }
}

TEST(InsideShare, CountsAPartThatIsSwallowedWhole) {
  const Surface both = joined(ball(Vec3f::Zero(), 0.5f), ball(Vec3f(0.1f, 0, 0), 0.2f));
  EXPECT_NEAR(share_of(both), 0.04 / (0.25 + 0.04), 1e-3);
  EXPECT_EQ(inside_share(Points3f(3, 0), Points3f(3, 0), Faces(3, 0)), 0);
}

}  // namespace
}  // namespace vitruvian
