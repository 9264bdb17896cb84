#include "measure/statistics.h"

#include <gtest/gtest.h>

namespace vitruvian {
namespace {

TEST(Statistics, KnownSet) {
  const DistanceStatistics s = distance_statistics({0.004f, 0.001f, 0.003f, 0.002f, 0.010f});
  EXPECT_EQ(s.count, 5);
  EXPECT_NEAR(s.mean_mm, 4, 1e-6);
  EXPECT_NEAR(s.std_mm, 3.16227766, 1e-5);
  EXPECT_NEAR(s.median_mm, 3, 1e-6);
  EXPECT_NEAR(s.p95_mm, 8.8, 1e-5);
  EXPECT_NEAR(s.max_mm, 10, 1e-6);
}

TEST(Statistics, OneAndNone) {
  const DistanceStatistics one = distance_statistics({0.007f});
  EXPECT_EQ(one.count, 1);
  EXPECT_NEAR(one.p95_mm, 7, 1e-6);
  EXPECT_EQ(one.std_mm, 0);
  EXPECT_EQ(distance_statistics({}).count, 0);
}

}  // namespace
}  // namespace vitruvian
