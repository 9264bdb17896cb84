#include "align/units.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

TEST(Units, StandingAdultsAreRecognised) {
  for (double extent_m = 1.35; extent_m <= 2.3; extent_m += 0.05) {
    EXPECT_EQ(guess_unit(extent_m).candidates[0].unit, "m");
    EXPECT_EQ(guess_unit(extent_m * 100).candidates[0].unit, "cm");
    EXPECT_EQ(guess_unit(extent_m * 1000).candidates[0].unit, "mm");
    EXPECT_EQ(guess_unit(extent_m / 0.0254).candidates[0].unit, "in") << extent_m;
  }
}

TEST(Units, SittingAndCrouchingBodiesAreAmongTheCandidates) {
  for (double extent_m = 0.7; extent_m <= 1.4; extent_m += 0.05) {
    for (const double unit : {1.0, 0.01, 0.001, 0.0254}) {
      const UnitGuess guess = guess_unit(extent_m / unit);
      bool listed = false;
      for (const UnitCandidate& candidate : guess.candidates) {
        listed = listed || candidate.metres_per_unit == unit;
        EXPECT_NEAR(candidate.extent_m, extent_m / unit * candidate.metres_per_unit, 1e-9);
      }
      EXPECT_TRUE(listed) << extent_m << " " << unit;
    }
  }
}

TEST(Units, CentimetresAndInchesAreCalledAmbiguous) {
  for (const double extent : {50.0, 60.0, 70.0, 85.0, 98.0}) {
    const UnitGuess guess = guess_unit(extent);
    EXPECT_TRUE(guess.ambiguous) << extent;
    ASSERT_EQ(guess.candidates.size(), 2u);
    EXPECT_NE(guess.note.find("inches"), std::string::npos);
    EXPECT_NE(guess.note.find("centimetres"), std::string::npos);
    EXPECT_GE(guess.candidates[0].likelihood, guess.candidates[1].likelihood);
  }
  EXPECT_FALSE(guess_unit(1.75).ambiguous);
  EXPECT_FALSE(guess_unit(175).ambiguous);
  EXPECT_FALSE(guess_unit(1750).ambiguous);
  EXPECT_TRUE(guess_unit(1.75).note.empty());
}

TEST(Units, DeclaredUnitIsBelievedUnlessAbsurd) {
  const UnitGuess believed = guess_unit(0.8, 1.0);
  ASSERT_EQ(believed.candidates.size(), 1u);
  EXPECT_EQ(believed.candidates[0].unit, "m");
  EXPECT_FALSE(believed.ambiguous);
  EXPECT_EQ(guess_unit(178, 1.0).candidates[0].unit, "cm");
}

TEST(Units, ImpossibleSizesGetTheNearestUnitAndANote) {
  for (const double extent : {0.1, 8.0, 12.0, 1e5, 1e-6}) {
    const UnitGuess guess = guess_unit(extent);
    ASSERT_EQ(guess.candidates.size(), 1u) << extent;
    EXPECT_TRUE(guess.ambiguous);
    EXPECT_FALSE(guess.note.empty());
  }
  EXPECT_THROW(guess_unit(0), Error);
  EXPECT_THROW(guess_unit(-1), Error);
  EXPECT_THROW(guess_unit(NAN), Error);
  EXPECT_THROW(guess_unit(INFINITY), Error);
}

}  // namespace
}  // namespace vitruvian
