#include "editor/line_of_sight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"

namespace vitruvian {
namespace {

/// An upright tube with open ends, as a limb is.
struct Tube {
  Points3f vertices;
  Faces faces;
};

Tube tube(const Vec3d& centre, double radius, double unit) {
  constexpr int around = 48, rings = 20;
  Tube result{Points3f(3, around * rings), Faces(3, 2 * around * (rings - 1))};
  for (int r = 0; r < rings; ++r) {
    for (int a = 0; a < around; ++a) {
      const double angle = 2 * std::numbers::pi * a / around;
      const Vec3d at =
          centre + Vec3d(radius * std::cos(angle), 0.5 * r / (rings - 1) - 0.25, radius * std::sin(angle));
      result.vertices.col(r * around + a) = (at * unit).cast<float>();
      if (r + 1 == rings) continue;
      const int next = (a + 1) % around, f = 2 * (r * around + a);
      result.faces.col(f) << r * around + a, r * around + next, (r + 1) * around + a;
      result.faces.col(f + 1) << r * around + next, (r + 1) * around + next, (r + 1) * around + a;
    }
  }
  return result;
}

Tube both(const Tube& a, const Tube& b) {
  Tube result{Points3f(3, a.vertices.cols() + b.vertices.cols()), Faces(3, a.faces.cols() + b.faces.cols())};
  result.vertices << a.vertices, b.vertices;
  result.faces << a.faces, (b.faces.array() + static_cast<int>(a.vertices.cols())).matrix();
  return result;
}

TEST(LineOfSight, FindsTheMiddleOfALimbInAnyUnit) {
  Random random(21);
  for (const double unit : {1.0, 100.0, 1000.0}) {
    const Vec3d centre(0.1, 0.3, -0.2);
    const Tube limb = tube(centre, 0.05, unit);
    for (int i = 0; i < 20; ++i) {
      const double x = random.uniform(-0.03, 0.03), y = random.uniform(-0.2, 0.2);
      const LineOfSight line{unit * (centre + Vec3d(x, y, 3)), Vec3d(0, 0, -7)};
      const auto middle = middle_of_body(limb.vertices, limb.faces, line, 0, 1 / unit);
      ASSERT_TRUE(middle) << "seed 21, " << i << ", unit " << unit;
      EXPECT_LT((*middle / unit - (centre + Vec3d(x, y, 0))).norm(), 1e-3) << "seed 21, " << i;
    }
  }
}

TEST(LineOfSight, OfLimbsBehindOneAnotherTakesTheNearerToWhereTheJointIs) {
  const Tube limbs = both(tube({0, 0, 0}, 0.05, 1), tube({0, 0, 0.4}, 0.05, 1));
  const LineOfSight line{{0.01, 0, 3}, {0, 0, -1}};
  EXPECT_NEAR(middle_of_body(limbs.vertices, limbs.faces, line, 2.6, 1)->z(), 0.4, 1e-3);
  EXPECT_NEAR(middle_of_body(limbs.vertices, limbs.faces, line, 2.9, 1)->z(), 0.0, 1e-3);
}

TEST(LineOfSight, LeavesTheJointWhereNothingSensibleIsSeen) {
  const Tube limb = tube({0, 0, 0}, 0.05, 1), trunk = tube({0, 0, 0}, 0.2, 1);
  EXPECT_FALSE(middle_of_body(limb.vertices, limb.faces, {{0.2, 0, 3}, {0, 0, -1}}, 3, 1)) << "beside it";
  EXPECT_FALSE(middle_of_body(trunk.vertices, trunk.faces, {{0, 0, 3}, {0, 0, -1}}, 3, 1)) << "too thick";
  Faces half(3, limb.faces.cols());
  Index kept = 0;
  for (Index f = 0; f < limb.faces.cols(); ++f)
    if (limb.vertices(2, limb.faces(0, f)) >= 0) half.col(kept++) = limb.faces.col(f);
  half.conservativeResize(3, kept);
  EXPECT_FALSE(middle_of_body(limb.vertices, half, {{0.01, 0, 3}, {0, 0, -1}}, 3, 1)) << "no back side";
}

TEST(LineOfSight, WorksOnBarePoints) {
  const Tube limb = tube({0, 0, 0}, 0.05, 1);
  const double ring = 0.5 * 10 / 19 - 0.25;
  const auto middle = middle_of_body(limb.vertices, Faces(3, 0), {{0, ring, 3}, {0, 0, -1}}, 3, 1);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->z(), 0, 2e-3);
}

}  // namespace
}  // namespace vitruvian
