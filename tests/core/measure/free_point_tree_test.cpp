#include "measure/free_point_tree.h"

#include <gtest/gtest.h>

#include <set>

#include "base/random.h"

namespace vitruvian {
namespace {

int brute_force(const Points3f& points, const std::set<int>& taken, const Vec3f& query, float half_width) {
  int best = -1;
  float best_squared = 0;
  for (Index i = 0; i < points.cols(); ++i) {
    const Vec3f difference = points.col(i) - query;
    if (taken.count(static_cast<int>(i)) || difference.cwiseAbs().maxCoeff() > half_width) continue;
    if (best < 0 || difference.squaredNorm() < best_squared) {
      best = static_cast<int>(i);
      best_squared = difference.squaredNorm();
    }
  }
  return best;
}

TEST(FreePointTree, AgreesWithBruteForceUntilEmpty) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    Random random(seed);
    // Coordinates on coarse lattices of exact floats: equal distances and equal points are frequent, nothing
    // is rounded.
    Points3f points(3, 500);
    for (Index i = 0; i < points.size(); ++i) points(i) = 0.125f * static_cast<float>(random.below(8));
    FreePointTree tree(points);
    std::set<int> taken;
    while (tree.free_count() > 0) {
      Vec3f query;
      for (int k = 0; k < 3; ++k) query[k] = 0.0625f * static_cast<float>(random.below(18));
      const float half_width = static_cast<float>(random.uniform(0.02, 0.4));
      ASSERT_EQ(tree.nearest(query, half_width), brute_force(points, taken, query, half_width));
      const int found = tree.nearest(query);
      ASSERT_EQ(found, brute_force(points, taken, query, 1e9f));
      tree.take(found);
      taken.insert(found);
    }
    EXPECT_EQ(taken.size(), 500u);
    EXPECT_EQ(tree.nearest(Vec3f::Zero()), -1);
  }
}

TEST(FreePointTree, ManyEqualPointsAreGivenOutInOrder) {
  const Points3f points = Points3f::Constant(3, 200, 0.25f);
  FreePointTree tree(points);
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(tree.nearest(Vec3f::Zero()), i);
    tree.take(i);
  }
}

}  // namespace
}  // namespace vitruvian
