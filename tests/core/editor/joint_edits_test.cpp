#include "editor/joint_edits.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/error.h"
#include "core/pipeline/all_knowing_network.h"
#include "editor/pose_preview.h"
#include "pipeline/given_keypoints.h"

namespace vitruvian {
namespace {

/// A body turned anywhere: hips, shoulders and the left limbs.
KeypointSet left_half(const Mat3d& turn, const Vec3d& shift) {
  const std::map<std::string, Vec3d> places = {
      {"left_hip", {0.1, 0.9, 0}},      {"right_hip", {-0.1, 0.9, 0}},
      {"left_shoulder", {0.2, 1.4, 0}}, {"right_shoulder", {-0.2, 1.4, 0}},
      {"left_knee", {0.15, 0.5, 0.1}},  {"left_elbow", {0.5, 1.3, 0.2}},
      {"pelvis", {0, 0.95, 0}}};
  KeypointSet set;
  for (const auto& [name, place] : places) set.joints[name] = {turn * place + shift, 0.75};
  return set;
}

TEST(JointEdits, MirroringPutsLimbsAtTheirImage) {
  const Mat3d turn = Eigen::AngleAxisd(1.1, Vec3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Vec3d shift(100, -7, 3);
  const JointChanges changes = mirrored_limbs(left_half(turn, shift), BodySide::left, {});
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_LT((changes.at("right_knee")->position - (turn * Vec3d(-0.15, 0.5, 0.1) + shift)).norm(), 1e-9);
  EXPECT_LT((changes.at("right_elbow")->position - (turn * Vec3d(-0.5, 1.3, 0.2) + shift)).norm(), 1e-9);
  EXPECT_EQ(changes.at("right_knee")->confidence, 0.75);
  EXPECT_EQ(mirrored_limbs(left_half(turn, shift), BodySide::left, {"right_knee"}).count("right_knee"), 0u);
  EXPECT_TRUE(mirrored_limbs(left_half(turn, shift), BodySide::right, {}).empty()) << "nothing to copy";
  EXPECT_THROW(mirrored_limbs({KeypointFrame::scan, {{"left_knee", {}}}}, BodySide::left, {}), Error);
}

TEST(JointEdits, SwappingTwiceGivesTheSame) {
  KeypointSet set = left_half(Mat3d::Identity(), Vec3d::Zero());
  const KeypointSet before = set;
  for (int i = 0; i < 2; ++i) {
    for (const auto& [name, joint] : swapped_sides(set, {})) {
      if (joint) set.joints[name] = *joint;
      if (!joint) set.joints.erase(name);
    }
    if (i == 0) {
      EXPECT_EQ(set.joints.at("right_knee"), before.joints.at("left_knee"));
      EXPECT_EQ(set.joints.count("left_knee"), 0u);
      EXPECT_EQ(set.joints.at("pelvis"), before.joints.at("pelvis"));
    }
  }
  EXPECT_EQ(set, before);
  EXPECT_EQ(swapped_sides(before, {"left_hip"}).count("right_hip"), 0u) << "its partner is locked";
}

TEST(PosePreview, FollowsDraggedJointsAsFarAsABodyCan) {
  const BodyState truth = testing::standing();
  const Skeleton skeleton = pose_skeleton(testing::models().body, truth);
  std::vector<Keypoint> keypoints = keypoints_in_body({}, Mat4d::Identity());
  for (int j = 0; j < 22; ++j) {
    keypoints[static_cast<std::size_t>(j)].position_m = skeleton.joints.col(j);
    keypoints[static_cast<std::size_t>(j)].confidence = 1;
  }
  PosePreview preview(testing::models(), Gender::neutral, 0);
  preview.begin(joint_targets(keypoints));
  preview.follow(joint_targets(keypoints), 4);
  EXPECT_LT(preview.error(joint_targets(keypoints)), 0.02);

  // A wrist is pulled up and forward in small steps, as a pointer does.
  const std::size_t wrist = 20;
  for (int step = 0; step < 20; ++step) {
    *keypoints[wrist].position_m += Vec3d(0, 0.01, 0.01);
    preview.follow(joint_targets(keypoints), 4);
  }
  const Vec3d reached = pose_skeleton(testing::models().body, preview.state()).joints.col(20);
  EXPECT_LT((reached - *keypoints[wrist].position_m).norm(), 0.06);
  const BodyState before = preview.state();
  preview.follow({}, 4);
  EXPECT_EQ(preview.state().translation, before.translation) << "nothing to follow";
}

}  // namespace
}  // namespace vitruvian
