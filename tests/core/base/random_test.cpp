#include "base/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace vitruvian {
namespace {

TEST(Random, TheSameSeedGivesTheSameNumbersEverywhere) {
  // From the specification of mt19937 (seed 5489: the 10000th number is 4123659995) through uniform()'s
  // formula.
  Random random(5489);
  for (int i = 0; i < 4999; ++i) random.uniform();
  std::mt19937 engine(5489);
  engine.discard(9998);
  const std::uint64_t high = engine() >> 5, last = engine();
  EXPECT_EQ(last, 4123659995u);
  EXPECT_EQ(random.uniform(), (high * 67108864.0 + static_cast<double>(last >> 6)) / 9007199254740992.0);
}

TEST(Random, UniformStaysInRangeAndIsFlat) {
  Random random(1);
  std::vector<int> histogram(10);
  for (int i = 0; i < 100000; ++i) {
    const double value = random.uniform();
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    ++histogram[static_cast<std::size_t>(10 * value)];
  }
  // Six standard deviations of a binomial count.
  for (const int count : histogram) EXPECT_NEAR(count, 10000, 570);
}

TEST(Random, BelowReachesEveryValueAndNoOther) {
  Random random(2);
  std::vector<int> histogram(7);
  for (int i = 0; i < 7000; ++i) {
    const std::uint32_t value = random.below(7);
    ASSERT_LT(value, 7u);
    ++histogram[value];
  }
  for (const int count : histogram) EXPECT_NEAR(count, 1000, 180);
}

TEST(Random, NormalHasMeanZeroVarianceOneAndNoSkew) {
  Random random(3);
  double sum = 0, squares = 0, cubes = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    ASSERT_TRUE(std::isfinite(value));
    sum += value, squares += value * value, cubes += value * value * value;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.015);
  EXPECT_NEAR(squares / kCount, 1, 0.02);
  EXPECT_NEAR(cubes / kCount, 0, 0.06);
}

}  // namespace
}  // namespace vitruvian
