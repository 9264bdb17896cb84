#include "pipeline/given_keypoints.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/error.h"
#include "base/random.h"
#include "keypoints/left_right.h"

namespace vitruvian {
namespace {

/// A person that stands in the body frame, arms hanging.
std::map<std::string, Vec3d> person() {
  return {{"pelvis", {0, 0.95, 0}},           {"left_hip", {0.1, 0.9, 0}},
          {"right_hip", {-0.1, 0.9, 0}},      {"left_knee", {0.12, 0.5, 0.02}},
          {"right_knee", {-0.12, 0.5, 0}},    {"left_ankle", {0.12, 0.1, 0}},
          {"right_ankle", {-0.12, 0.1, 0}},   {"neck", {0, 1.45, 0}},
          {"head", {0, 1.6, 0.02}},           {"left_shoulder", {0.18, 1.4, 0}},
          {"right_shoulder", {-0.18, 1.4, 0}}};
}

KeypointSet in_scan(const Mat4d& scan_from_body) {
  KeypointSet set{KeypointFrame::scan, {}};
  for (const auto& [name, position] : person())
    set.joints[name] = {(scan_from_body * position.homogeneous()).head<3>(), 1};
  return set;
}

Mat4d scan_from_body(const Mat3d& rotation) {
  Mat4d transform = Mat4d::Identity();
  transform.topLeftCorner<3, 3>() = 1000 * rotation;
  transform.topRightCorner<3, 1>() = Vec3d(500, -2000, 70);
  return transform;
}

TEST(RotationFromKeypoints, UndoesAnyTurnAboutAnyScanAxis) {
  for (const Vec3d& up :
       {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(-1, 0, 0), Vec3d(0, -1, 0), Vec3d(0, 0, -1)}) {
    for (const double yaw : {0.0, 0.7, 2.5, -1.9}) {
      const Mat3d scan_from_upright =
          Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitY(), up).toRotationMatrix();
      const Mat3d truth = scan_from_upright * Eigen::AngleAxisd(yaw, Vec3d::UnitY()).toRotationMatrix();
      const Mat3d found = rotation_from_keypoints(in_scan(scan_from_body(truth)), {}, {});
      EXPECT_TRUE((found * truth).isApprox(Mat3d::Identity(), 1e-9)) << up.transpose() << " yaw " << yaw;
    }
  }
}

TEST(RotationFromKeypoints, SnapsToAnAxisNearTheBodysLineAndElseTakesTheLine) {
  // Leaning 15 degrees: still the axis; 40 degrees between axes: the line.
  const Mat3d leaning = Eigen::AngleAxisd(0.26, Vec3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE((rotation_from_keypoints(in_scan(scan_from_body(leaning)), {}, {}) * Vec3d::UnitY())
                  .isApprox(Vec3d::UnitY(), 1e-9));
  const Mat3d oblique = Eigen::AngleAxisd(0.7, Vec3d(1, 0, 1).normalized()).toRotationMatrix();
  const Vec3d line =
      rotation_from_keypoints(in_scan(scan_from_body(oblique)), {}, {}) * oblique * Vec3d::UnitY();
  EXPECT_GT(line.y(), 0.99);
}

TEST(RotationFromKeypoints, TakesWhatIsGiven) {
  const KeypointSet set = in_scan(scan_from_body(Mat3d::Identity()));
  const Mat3d rotation = rotation_from_keypoints(set, Vec3d(0, 0, 1), Vec3d(1, 0, 0));
  EXPECT_TRUE((rotation * Vec3d::UnitZ()).isApprox(Vec3d::UnitY(), 1e-12));
  EXPECT_TRUE((rotation * Vec3d::UnitX()).isApprox(Vec3d::UnitZ(), 1e-12));
}

TEST(RotationFromKeypoints, AsksForUpWhenTheJointsDoNotTell) {
  KeypointSet arms{KeypointFrame::scan, {{"left_wrist", {}}, {"right_wrist", {}}, {"left_elbow", {}}}};
  try {
    rotation_from_keypoints(arms, {}, {});
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("--up"), std::string::npos);
  }
  EXPECT_TRUE((rotation_from_keypoints(arms, Vec3d(0, 1, 0), {}) * Vec3d::UnitY()).isApprox(Vec3d::UnitY()));
}

TEST(KeypointsInBody, AreTheSameFromAllThreeFrames) {
  const Mat4d to_scan =
      scan_from_body(Eigen::AngleAxisd(1.0, Vec3d(1, 2, 3).normalized()).toRotationMatrix());
  KeypointSet body{KeypointFrame::body, {}}, canonical{KeypointFrame::canonical, {}};
  for (const auto& [name, position] : person()) {
    body.joints[name] = {position, 0.5};
    canonical.joints[name] = {canonical_from_body_rotation() * position, 0.5};
  }
  const auto from_scan = keypoints_in_body(in_scan(to_scan), to_scan.inverse());
  const auto from_body = keypoints_in_body(body, Mat4d::Constant(7)),
             from_canonical = keypoints_in_body(canonical, Mat4d::Constant(7));
  ASSERT_EQ(from_scan.size(), 22u);
  for (std::size_t j = 0; j < 22; ++j) {
    SCOPED_TRACE(from_scan[j].joint);
    EXPECT_EQ(from_scan[j].joint, kSmplJointNames[j]);
    const bool known = person().count(from_scan[j].joint) > 0;
    EXPECT_EQ(from_scan[j].position_m.has_value(), known);
    EXPECT_EQ(from_scan[j].source, known ? KeypointSource::user : KeypointSource::none);
    if (!known) continue;
    EXPECT_TRUE(from_scan[j].position_m->isApprox(person()[from_scan[j].joint], 1e-9));
    EXPECT_EQ(*from_body[j].position_m, person()[from_scan[j].joint]);
    EXPECT_TRUE(from_canonical[j].position_m->isApprox(*from_body[j].position_m, 1e-12));
    EXPECT_EQ(from_body[j].confidence, 0.5);
  }
  const auto targets = joint_targets(from_body);
  ASSERT_EQ(targets.size(), person().size());
  for (const LandmarkTarget& t : targets) {
    EXPECT_EQ(t.target, person()[std::string(kSmplJointNames[t.joint])]);
    EXPECT_EQ(t.offset.norm(), 0);
    EXPECT_EQ(t.weight, 0.5);
  }
}

}  // namespace
}  // namespace vitruvian
