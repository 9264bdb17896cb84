#include "align/frame.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "../keypoints/synthetic_person.h"
#include "base/error.h"
#include "body_shapes.h"

namespace vitruvian {
namespace {

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

TEST(Frame, RotationTakesUpToYAndFrontToZ) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Mat3d scan_from_body = random_rotation(random);
    const Vec3d up = 3 * scan_from_body.col(1), front = scan_from_body.col(2) + 0.4 * scan_from_body.col(1);
    EXPECT_LT((body_from_scan_rotation(up, front) - scan_from_body.transpose()).norm(), 1e-9);
    const Mat3d free = body_from_scan_rotation(up);
    EXPECT_LT((free * up.normalized() - Vec3d::UnitY()).norm(), 1e-9);
    EXPECT_NEAR(free.determinant(), 1, 1e-9);
    EXPECT_LT((free * free.transpose() - Mat3d::Identity()).norm(), 1e-9);
  }
  EXPECT_LT((body_from_scan_rotation(Vec3d::UnitY()) - Mat3d::Identity()).norm(), 1e-12);
  EXPECT_THROW(body_from_scan_rotation(Vec3d::Zero()), Error);
  EXPECT_THROW(body_from_scan_rotation(Vec3d::UnitX(), Vec3d(-2, 0, 0)), Error);
}

TEST(Frame, TransformCarriesUnitAndCentroid) {
  Random random(3);
  const Mat3d rotation = random_rotation(random);
  const Vec3d centroid(120, -45, 800);
  const Mat4d transform = body_from_scan(rotation, centroid, 0.01);
  EXPECT_LT((transform * centroid.homogeneous()).head<3>().norm(), 1e-12);
  const Vec3d moved =
      (transform * (centroid + rotation.transpose() * Vec3d(100, 0, 0)).homogeneous()).head<3>();
  EXPECT_LT((moved - Vec3d::UnitX()).norm(), 1e-9);
}

TEST(Frame, YawIsFoundAndTurnedForward) {
  for (const auto& person : {standing_person(), left_arm_raised()}) {
    for (double yaw = -3; yaw <= 3; yaw += 0.5) {
      std::vector<Landmark3d> landmarks = certain(person);
      turn_forward(landmarks, -yaw);
      const auto facing = yaw_from_landmarks(landmarks);
      ASSERT_TRUE(facing);
      EXPECT_NEAR(std::remainder(facing->yaw - yaw, 2 * std::numbers::pi), 0, 1e-5);
      EXPECT_GT(facing->confidence, 0.99);
      turn_forward(landmarks, facing->yaw);
      for (int l = 0; l < kLandmarkCount; ++l) EXPECT_LT((landmarks[l].position - person[l]).norm(), 1e-5);
      const Vec3d front(std::sin(yaw), 0, std::cos(yaw));
      const Mat4d turned = facing_forward(Mat4d::Identity(), facing->yaw);
      EXPECT_LT((turned * front.homogeneous() - Vec3d::UnitZ().homogeneous()).norm(), 1e-5);
    }
  }
}

TEST(Frame, LyingBodiesTurnAsIfTheyHadFallen) {
  for (const double pitch : {-1.45, -1.2, -0.6, 0.6, 1.2, 1.45}) {
    for (const double yaw : {0.0, 1.0, -2.5}) {
      const Mat3f fall = (Eigen::AngleAxisd(yaw, Vec3d::UnitY()) * Eigen::AngleAxisd(pitch, Vec3d::UnitX()))
                             .toRotationMatrix()
                             .cast<float>();
      std::vector<Landmark3d> landmarks = certain(standing_person());
      for (Landmark3d& landmark : landmarks) landmark.position = fall * landmark.position;
      const auto facing = yaw_from_landmarks(landmarks);
      ASSERT_TRUE(facing);
      EXPECT_NEAR(std::remainder(facing->yaw - yaw, 2 * std::numbers::pi), 0, 0.05) << pitch;
    }
  }
}

TEST(Frame, ContradictionsLowerTheFacingsConfidence) {
  std::vector<Landmark3d> landmarks = certain(standing_person());
  std::swap(landmarks[23], landmarks[24]);
  EXPECT_LT(yaw_from_landmarks(landmarks)->confidence, 0.4);
  landmarks = certain(standing_person());
  landmarks[0].position.z() = -0.2f;
  EXPECT_LT(yaw_from_landmarks(landmarks)->confidence, 0.4);
  landmarks[12].confidence = 0;
  EXPECT_FALSE(yaw_from_landmarks(landmarks));
  for (Landmark3d& landmark : landmarks) landmark = {Vec3f::Zero(), 1, 0};
  EXPECT_FALSE(yaw_from_landmarks(landmarks));
}

TEST(Frame, AxisNamesRoundTrip) {
  for (const char* name : {"x", "y", "z", "-x", "-y", "-z"}) EXPECT_EQ(nearest_axis(axis_vector(name)), name);
  EXPECT_EQ(nearest_axis({0.1, -0.9, 0.3}), "-y");
  for (const char* bad : {"", "-", "w", "xy", "--x", "auto"}) EXPECT_THROW(axis_vector(bad), Error) << bad;
}

TEST(Frame, PcaUndoesSmallTurnsOfAnUprightFigure) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Points3f model = scattered_figure(random, 6000);
    // Up stays within 45 degrees of a positive scan axis, as the rule for the first direction's sign asks
    // for.
    const Mat3d lay =
        seed % 2 ? Mat3d::Identity() : Mat3d(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3d::UnitX()));
    const Mat3d scan_from_body =
        Eigen::AngleAxisd(random.uniform(-0.5, 0.5),
                          Vec3d(random.normal(), random.normal(), random.normal()).normalized())
            .toRotationMatrix() *
        lay * Eigen::AngleAxisd(random.uniform(-3, 3), Vec3d::UnitY()).toRotationMatrix();
    const Points3f scan =
        (scan_from_body.cast<float>() * scattered_figure(random, 6000)).colwise() + Vec3f(3, -2, 9);
    const Mat3d found = align_pca(scan, model);
    EXPECT_NEAR(found.determinant(), 1, 1e-9);
    EXPECT_LT(angle_between(found * scan_from_body.col(1), Vec3d::UnitY()), 0.1);
    EXPECT_LT(angle_between(found * scan_from_body.col(2), Vec3d::UnitZ()), 0.15);
  }
  EXPECT_THROW(align_pca(Points3f::Random(3, 3), Points3f::Random(3, 9)), Error);
}

}  // namespace
}  // namespace vitruvian
