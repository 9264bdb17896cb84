#include "keypoints/left_right.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <numbers>
#include <set>

#include "base/error.h"
#include "synthetic_person.h"

namespace vitruvian {
namespace {

/// A person in the canonical frame (Z up, facing +Y, left at smaller X), optionally facing -Y (turned by half
/// a turn about Z) and upside down (turned by half a turn about Y, which keeps the facing direction).
std::vector<Landmark3d> canonical_person(bool faces_away, bool upside_down) {
  std::vector<Landmark3d> landmarks = certain(standing_person());
  const Mat3f canonical_from_body = canonical_from_body_rotation().cast<float>();
  for (Landmark3d& landmark : landmarks) {
    landmark.position = canonical_from_body * landmark.position;
    if (faces_away) landmark.position.head<2>() *= -1;
    if (upside_down) {
      landmark.position.x() *= -1;
      landmark.position.z() *= -1;
    }
  }
  return landmarks;
}

void exchange(std::vector<Landmark3d>& landmarks, int left, int right) {
  std::swap(landmarks[left], landmarks[right]);
}

TEST(LeftRight, CanonicalFrameIsAsAgreed) {
  const Mat3d rotation = canonical_from_body_rotation();
  EXPECT_NEAR(rotation.determinant(), 1, 1e-12);
  EXPECT_EQ(Vec3d(rotation * Vec3d::UnitY()), Vec3d(0, 0, 1));
  EXPECT_EQ(Vec3d(rotation * Vec3d::UnitZ()), Vec3d(0, 1, 0));
  EXPECT_EQ(Vec3d(rotation * Vec3d::UnitX()), Vec3d(-1, 0, 0));
}

// Section 3.1.1: a half turn about (0, 1, 1) / sqrt 2, or pi/2 about X and then pi about Z.
TEST(LeftRight, TheRootSeedIsTheCanonicalFrame) {
  const double pi = std::numbers::pi;
  const Vec3d seed(0, pi / std::numbers::sqrt2, pi / std::numbers::sqrt2);
  const Mat3d rotation = Eigen::AngleAxisd(seed.norm(), seed.normalized()).toRotationMatrix();
  EXPECT_TRUE(rotation.isApprox(canonical_from_body_rotation(), 1e-12));
  const Mat3d in_two_turns =
      (Eigen::AngleAxisd(pi, Vec3d::UnitZ()) * Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())).toRotationMatrix();
  EXPECT_TRUE(in_two_turns.isApprox(rotation, 1e-12));
}

TEST(LeftRight, EveryPairedLandmarkIsInThePairsOnce) {
  std::set<int> seen;
  for (const auto& [left, right] : kLandmarkPairs) {
    EXPECT_TRUE(seen.insert(left).second);
    EXPECT_TRUE(seen.insert(right).second);
  }
  EXPECT_EQ(seen.size(), 32u);
  EXPECT_EQ(seen.count(0), 0u);
}

/// The four rows of appendix B's table.
class Table : public testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(Table, RightOrderIsConsistentWrongOrderIsExchanged) {
  const auto [faces_away, upside_down] = GetParam();
  std::vector<Landmark3d> landmarks = canonical_person(faces_away, upside_down);
  EXPECT_EQ(check_left_right(landmarks), LeftRightFinding::consistent);
  exchange_left_right(landmarks);
  EXPECT_EQ(check_left_right(landmarks), LeftRightFinding::exchanged);
  exchange_left_right(landmarks);
  // Shoulders alone decide.
  exchange(landmarks, 11, 12);
  EXPECT_EQ(check_left_right(landmarks), LeftRightFinding::exchanged);
  exchange(landmarks, 11, 12);
  // Hips alone do not, unless the knees support them.
  exchange(landmarks, 23, 24);
  EXPECT_EQ(check_left_right(landmarks), LeftRightFinding::consistent);
  exchange(landmarks, 25, 26);
  EXPECT_EQ(check_left_right(landmarks), LeftRightFinding::exchanged);
  landmarks[26].confidence = 0;
  EXPECT_EQ(check_left_right(landmarks), LeftRightFinding::consistent);
}

INSTANTIATE_TEST_SUITE_P(Rows, Table, testing::Combine(testing::Bool(), testing::Bool()));

TEST(LeftRight, NeedsNoseShouldersAndHips) {
  for (const int required : {0, 11, 12, 23, 24}) {
    std::vector<Landmark3d> landmarks = canonical_person(false, false);
    exchange_left_right(landmarks);
    landmarks[required].confidence = 0;
    EXPECT_EQ(check_left_right(landmarks), LeftRightFinding::unavailable) << required;
  }
  EXPECT_THROW(check_left_right(std::vector<Landmark3d>(32)), Error);
}

TEST(LeftRight, CorrectionExchangesPositionAndConfidenceOfAllPairs) {
  const std::vector<Landmark3d> truth = [] {
    std::vector<Landmark3d> landmarks = certain(left_arm_raised());
    for (int l = 0; l < kLandmarkCount; ++l) landmarks[l].confidence = 0.5f + 0.01f * static_cast<float>(l);
    return landmarks;
  }();
  std::vector<Landmark3d> landmarks = truth;
  EXPECT_EQ(correct_left_right(landmarks), LeftRightFinding::consistent);
  exchange_left_right(landmarks);
  EXPECT_EQ(correct_left_right(landmarks), LeftRightFinding::exchanged);
  for (int l = 0; l < kLandmarkCount; ++l) {
    EXPECT_EQ(landmarks[l].position, truth[l].position) << l;
    EXPECT_EQ(landmarks[l].confidence, truth[l].confidence) << l;
  }
}

}  // namespace
}  // namespace vitruvian
