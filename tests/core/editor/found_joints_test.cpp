#include "editor/found_joints.h"

#include <gtest/gtest.h>

#include "core/pipeline/all_knowing_network.h"
#include "pipeline/landmark_stage.h"

namespace vitruvian {
namespace {

using testing::models;

/// What a perfect detector would see of a body.
PoseTargets seen_of(const Skeleton& skeleton) {
  std::vector<Landmark3d> landmarks(kLandmarkCount);
  for (const LandmarkOffset& o : models().landmarks) {
    const Vec3d place = skeleton.joints.col(o.joint) + skeleton.global[o.frame_joint] * o.offset;
    landmarks[o.landmark].position = place.cast<float>();
    landmarks[o.landmark].confidence = 1;
  }
  return {smpl_keypoints(landmarks), landmark_targets(models().landmarks, landmarks)};
}

double worst_distance(const std::vector<Keypoint>& keypoints, const Points3d& joints) {
  double worst = 0;
  for (std::size_t j = 0; j < keypoints.size(); ++j) {
    if (keypoints[j].position_m)
      worst = std::max(worst, (*keypoints[j].position_m - joints.col(static_cast<Index>(j))).norm());
  }
  return worst;
}

TEST(JointsOfModel, LieInTheBodyWhereLandmarksLieBesideThem) {
  const Skeleton skeleton = pose_skeleton(models().body, testing::standing());
  const FitModel model(models().body, models().prior, Gender::neutral, 0);
  const PoseTargets seen = seen_of(skeleton);
  EXPECT_GT(worst_distance(seen.keypoints, skeleton.joints), 0.045) << "the case is worth nothing otherwise";
  const std::vector<Keypoint> joints = joints_of_model(model, seen);
  ASSERT_EQ(joints.size(), seen.keypoints.size());
  EXPECT_LT(worst_distance(joints, skeleton.joints), 0.025);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    EXPECT_EQ(joints[j].confidence, seen.keypoints[j].confidence);
    EXPECT_EQ(joints[j].source, seen.keypoints[j].source);
  }
}

TEST(JointsOfModel, LeaveWhatAHandPlacedAndWhatIsUnknown) {
  const Skeleton skeleton = pose_skeleton(models().body, testing::standing());
  const FitModel model(models().body, models().prior, Gender::neutral, 0);
  PoseTargets seen = seen_of(skeleton);
  seen.keypoints[20].position_m = Vec3d(3, 2, 1);
  seen.keypoints[20].source = KeypointSource::user;
  seen.keypoints[0].position_m.reset();
  seen.keypoints[0].source = KeypointSource::none;
  const std::vector<Keypoint> joints = joints_of_model(model, seen);
  EXPECT_EQ(*joints[20].position_m, Vec3d(3, 2, 1));
  EXPECT_FALSE(joints[0].position_m);
  EXPECT_EQ(joints_of_model(model, {seen.keypoints, {}})[4].position_m, seen.keypoints[4].position_m);
}

}  // namespace
}  // namespace vitruvian
