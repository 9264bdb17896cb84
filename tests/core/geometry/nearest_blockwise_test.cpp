#include "geometry/nearest_blockwise.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace vitruvian {
namespace {

Points3f cloud(Index count, std::uint32_t seed) {
  Random random(seed);
  Points3f points(3, count);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] = static_cast<float>(random.normal());
  return points;
}

// Whatever the block size and the number of threads: the kd-tree's answers, bit for bit.
TEST(NearestBlockwise, EqualsTheKdTree) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Points3f from = cloud(700, seed), to = cloud(1300, seed + 100);
    const KdTree tree(to);
    for (const int chunk : {1, 7, 512, 5000}) {
      for (const int threads : {1, 2}) {
        const auto found = nearest_blockwise(from, to, chunk, Execution(threads));
        ASSERT_EQ(found.size(), 700u);
        for (Index i = 0; i < from.cols(); ++i) {
          const Neighbour expected = tree.nearest(Vec3f(from.col(i)));
          ASSERT_EQ(found[i].index, expected.index) << "chunk " << chunk << ", point " << i;
          ASSERT_EQ(found[i].squared_distance, expected.squared_distance);
        }
      }
    }
  }
}

TEST(NearestBlockwise, TiesGoToTheLowestIndexAcrossBlocks) {
  Points3f to(3, 6);
  to << 1, -1, 0, 0, 1, 5, 0, 0, 1, -1, 0, 5, 0, 0, 0, 0, 0, 5;
  for (const int chunk : {1, 2, 4, 6})
    EXPECT_EQ(nearest_blockwise(Points3f::Zero(3, 1), to, chunk, Execution(1))[0].index, 0) << chunk;
}

TEST(NearestBlockwise, StopsWhenCancelled) {
  Execution execution(1);
  execution.cancel();
  EXPECT_THROW(nearest_blockwise(cloud(10, 1), cloud(10, 2), 4, execution), Error);
}

TEST(NearestBlockwise, NoQueriesNoAnswers) {
  EXPECT_TRUE(nearest_blockwise(Points3f(3, 0), cloud(3, 1), 4, Execution(1)).empty());
}

}  // namespace
}  // namespace vitruvian
