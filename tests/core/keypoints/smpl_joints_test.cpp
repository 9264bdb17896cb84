#include "keypoints/smpl_joints.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "keypoints/left_right.h"
#include "synthetic_person.h"

namespace vitruvian {
namespace {

constexpr int kPelvis = 0, kSpine1 = 3, kSpine3 = 9, kNeck = 12, kLeftCollar = 13, kHead = 15;

std::vector<Landmark3d> person() { return certain(standing_person()); }

TEST(SmplJoints, DirectJointsAreCopied) {
  std::vector<Landmark3d> landmarks = person();
  for (int l = 0; l < kLandmarkCount; ++l) landmarks[l].confidence = 0.3f + 0.02f * static_cast<float>(l);
  const auto joints = smpl_joints(landmarks, SmplJointSettings());
  const std::pair<int, int> table[] = {{1, 23},  {2, 24},  {4, 25},  {5, 26},  {7, 27},  {8, 28},  {10, 31},
                                       {11, 32}, {16, 11}, {17, 12}, {18, 13}, {19, 14}, {20, 15}, {21, 16}};
  for (const auto& [joint, landmark] : table) {
    EXPECT_EQ(joints[joint].source, JointSource::detected);
    EXPECT_EQ(joints[joint].position, Vec3d(landmarks[landmark].position.cast<double>()));
    EXPECT_FLOAT_EQ(static_cast<float>(joints[joint].confidence), landmarks[landmark].confidence);
  }
  for (const int joint : {0, 3, 6, 9, 12, 13, 14, 15}) {
    EXPECT_EQ(joints[joint].source, JointSource::derived);
    EXPECT_GT(joints[joint].confidence, 0);
    EXPECT_LT(joints[joint].confidence, 1);
  }
}

TEST(SmplJoints, TrunkIsAStraightOrderedChain) {
  const SmplJointSettings settings;
  const auto joints = smpl_joints(person(), settings);
  const Vec3d pelvis = joints[kPelvis].position, neck = joints[kNeck].position;
  double below = 0;
  for (const int spine : {3, 6, 9}) {
    const double t = (joints[spine].position - pelvis).dot(neck - pelvis) / (neck - pelvis).squaredNorm();
    EXPECT_GT(t, below);
    EXPECT_LT((joints[spine].position - pelvis - t * (neck - pelvis)).norm(), 1e-6);
    below = t;
  }
  EXPECT_LT(below, 1);
  EXPECT_NEAR(below, settings.spine_fractions[2], 1e-9);
  EXPECT_GT(joints[kHead].position.y(), neck.y());
  // Above the hips' middle and below the neck.
  EXPECT_NEAR(pelvis.y(), -0.08 + settings.pelvis_fraction * (neck.y() + 0.08), 1e-6);
  // Between neck and shoulder, a little lower.
  EXPECT_GT(joints[kLeftCollar].position.x(), 0.01);
  EXPECT_LT(joints[kLeftCollar].position.x(), 0.18);
  EXPECT_LT(joints[kLeftCollar].position.y(), neck.y());
}

TEST(SmplJoints, MirroredPersonGivesMirroredJoints) {
  std::vector<Landmark3d> landmarks = certain(left_arm_raised());
  const auto joints = smpl_joints(landmarks, SmplJointSettings());
  for (Landmark3d& landmark : landmarks) landmark.position.x() *= -1;
  exchange_left_right(landmarks);
  const auto mirrored = smpl_joints(landmarks, SmplJointSettings());
  constexpr int kMirror[] = {0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10, 12, 14, 13, 15, 17, 16, 19, 18, 21, 20};
  for (int j = 0; j < kSmplKeypointCount; ++j) {
    const Vec3d expected = joints[j].position.cwiseProduct(Vec3d(-1, 1, 1));
    EXPECT_LT((mirrored[kMirror[j]].position - expected).norm(), 1e-6) << j;
  }
}

TEST(SmplJoints, HeadFallsBackFromEyesToNoseToNothing) {
  std::vector<Landmark3d> landmarks = person();
  const SmplJointSettings settings;
  const Vec3d ears(0, 0.64, 0.01), eyes(0, 0.66, 0.10), nose(0, 0.62, 0.12);
  auto joints = smpl_joints(landmarks, settings);
  const double best = joints[kHead].confidence;
  EXPECT_LT((joints[kHead].position - (ears + settings.head_back * (ears - eyes))).norm(), 1e-6);
  landmarks[2].confidence = 0;
  joints = smpl_joints(landmarks, settings);
  EXPECT_LT((joints[kHead].position - (ears + settings.head_back * (ears - nose))).norm(), 1e-6);
  EXPECT_LT(joints[kHead].confidence, best);
  landmarks[8].confidence = 0;
  joints = smpl_joints(landmarks, settings);
  EXPECT_LT((joints[kHead].position - nose).norm(), 1e-6);
  EXPECT_EQ(joints[kHead].source, JointSource::derived);
  landmarks[0].confidence = 0;
  joints = smpl_joints(landmarks, settings);
  EXPECT_EQ(joints[kHead].source, JointSource::none);
  EXPECT_EQ(joints[kHead].confidence, 0);
  EXPECT_EQ(joints[kNeck].source, JointSource::derived);
  EXPECT_LT((joints[kNeck].position - Vec3d(0, 0.43, 0)).norm(), 1e-6);
}

TEST(SmplJoints, MissingSourcesMakeNone) {
  std::vector<Landmark3d> landmarks = person();
  landmarks[24].confidence = 0;
  auto joints = smpl_joints(landmarks, SmplJointSettings());
  for (const int joint : {2, kPelvis, kSpine1, 6, kSpine3})
    EXPECT_EQ(joints[joint].source, JointSource::none) << joint;
  EXPECT_EQ(joints[kLeftCollar].source, JointSource::derived);
  landmarks = person();
  landmarks[11].confidence = 0;
  joints = smpl_joints(landmarks, SmplJointSettings());
  for (const int joint : {16, kNeck, kSpine1, kLeftCollar, 14})
    EXPECT_EQ(joints[joint].source, JointSource::none);
  EXPECT_EQ(joints[kPelvis].source, JointSource::derived);
  EXPECT_EQ(joints[kHead].source, JointSource::derived);
  landmarks.pop_back();
  EXPECT_THROW(smpl_joints(landmarks, SmplJointSettings()), Error);
}

TEST(SmplJoints, RaisedLeftArmIsTheLeftOne) {
  const auto joints = smpl_joints(certain(left_arm_raised()), SmplJointSettings());
  EXPECT_GT(joints[20].position.y(), joints[21].position.y() + 0.5);
}

}  // namespace
}  // namespace vitruvian
