#include "detail/folds.h"

#include <gtest/gtest.h>

#include "core/geometry/solids.h"

namespace vitruvian {
namespace {

TEST(Folds, ATurnedTriangleIsFound) {
  const testing::Solid cube = testing::unit_cube();
  const Points3d vertices = cube.vertices.cast<double>();
  Points3d displacement = Points3d::Zero(3, 8);
  EXPECT_TRUE(folded_faces(vertices, displacement, cube.faces).empty());
  // Vertex 0 pushed past the opposite corner: its triangles turn over.
  displacement.col(0) = Vec3d(3, 3, 3);
  EXPECT_FALSE(folded_faces(vertices, displacement, cube.faces).empty());
  // Turning the whole cube by a half turn turns four of its sides.
  displacement = -vertices;
  displacement.row(2).setZero();
  displacement *= 2;
  EXPECT_EQ(folded_faces(vertices, displacement, cube.faces).size(), 8u);
}

TEST(Folds, UnfoldLeavesNoFoldAndTouchesNothingFarAway) {
  const testing::Solid ball = testing::sphere(30, 40);
  const Points3d vertices = ball.vertices.cast<double>();
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Points3d displacement = 0.02 * vertices;
    const double size = random.uniform(0.05, 1.5);
    for (Index v = 0; v < vertices.cols(); ++v) {
      if (vertices(2, v) > 0.5)
        displacement.col(v) += size * Vec3d(random.normal(), random.normal(), random.normal());
    }
    const Points3d given = displacement;
    ASSERT_FALSE(folded_faces(vertices, displacement, ball.faces).empty());
    unfold(vertices, ball.faces, displacement);
    EXPECT_TRUE(folded_faces(vertices, displacement, ball.faces).empty());
    EXPECT_TRUE(folded_faces(vertices, displacement.cast<float>().cast<double>(), ball.faces).empty());
    for (Index v = 0; v < vertices.cols(); ++v) {
      if (vertices(2, v) < -0.5) {
        EXPECT_EQ(displacement.col(v), given.col(v));
      }
    }
  }
}

TEST(Folds, NothingFoldedNothingChanged) {
  const testing::Solid ball = testing::sphere(10, 14);
  const Points3d vertices = ball.vertices.cast<double>();
  Points3d displacement = 0.3 * vertices;
  const Points3d given = displacement;
  unfold(vertices, ball.faces, displacement);
  EXPECT_EQ(displacement, given);
}

}  // namespace
}  // namespace vitruvian
