#include "measure/joint_error.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "body/model.h"

namespace vitruvian {
namespace {

JointPositions random_body(std::uint32_t seed) {
  Random random(seed);
  JointPositions joints;
  for (std::size_t j = 0; j < 22; ++j) {
    joints[std::string(kSmplJointNames[j])] = Vec3d(random.normal(), random.normal(), random.normal());
  }
  return joints;
}

TEST(JointError, TranslationIsRemovedWithThePelvis) {
  const JointPositions truth = random_body(1);
  JointPositions found = truth;
  for (auto& [name, position] : found) position += Vec3d(3, -2, 1);
  EXPECT_NEAR(pelvis_aligned_errors(found, truth, 1000).max_mm, 0, 1e-9);
  found["left_wrist"] += Vec3d(0, 0.05, 0);
  const JointErrors errors = pelvis_aligned_errors(found, truth, 1000);
  EXPECT_NEAR(errors.max_mm, 50, 1e-9);
  EXPECT_EQ(errors.worst, "left_wrist");
  ASSERT_EQ(errors.joints.size(), 22u);
  EXPECT_EQ(errors.joints.front().joint, "pelvis");
  EXPECT_NEAR(errors.mean_mm, 50.0 / 22, 1e-9);
}

TEST(JointError, UnitsScaleTheResult) {
  const JointPositions truth = random_body(2);
  JointPositions found = truth;
  found["head"] += Vec3d(2, 0, 0);
  EXPECT_NEAR(pelvis_aligned_errors(found, truth, 25.4).max_mm, 50.8, 1e-9);
}

TEST(JointError, CoreErrorsRemoveTheMeanOffset) {
  const JointPositions truth = random_body(3);
  JointPositions found = truth;
  for (auto& [name, position] : found) position += Vec3d(0.1, 0.2, 0.3);
  found["pelvis"] += Vec3d(9, 9, 9);
  EXPECT_NEAR(core_joint_errors(found, truth, 1000).max_mm, 0, 1e-9) << "the pelvis is no core joint";
  found["right_knee"] += Vec3d(0.12, 0, 0);
  const JointErrors errors = core_joint_errors(found, truth, 1000);
  EXPECT_EQ(errors.worst, "right_knee");
  EXPECT_NEAR(errors.max_mm, 110, 1e-9);
  EXPECT_EQ(errors.joints.size(), 12u);
}

TEST(JointError, MissingJointsAreLeftOutAndAMissingPelvisIsAnError) {
  const JointPositions truth = random_body(4);
  JointPositions found = truth;
  found.erase("head");
  EXPECT_EQ(pelvis_aligned_errors(found, truth, 1).joints.size(), 21u);
  found.erase("pelvis");
  EXPECT_THROW(pelvis_aligned_errors(found, truth, 1), Error);
  EXPECT_THROW(pelvis_aligned_errors({{"pelvis", Vec3d::Zero()}}, truth, 1), Error);
  EXPECT_THROW(core_joint_errors({{"pelvis", Vec3d::Zero()}}, truth, 1), Error);
}

}  // namespace
}  // namespace vitruvian
