#include "anthropometry/dimensions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>

#include "anthropometry/landmark_table.h"
#include "anthropometry/posture.h"
#include "core/anthropometry/measured_body.h"

namespace vitruvian {
namespace {

using testing::measured_body;

const LandmarkSet& landmarks() {
  static const LandmarkSet set(measured_body());
  return set;
}

std::map<std::string, Dimension> dimensions_of(const BodyState& scanned_state, Posture posture,
                                               const FitQuality& fit = {}) {
  const Figure standing(measured_body(), standard_posture(measured_body(), scanned_state.betas));
  const Figure scanned(measured_body(), scanned_state);
  std::map<std::string, Dimension> result;
  for (const Dimension& d : measure_dimensions(standing, scanned, landmarks(), fit)) {
    if (d.posture == posture) EXPECT_TRUE(result.emplace(d.id, d).second) << d.id;
  }
  return result;
}

TEST(Landmarks, LieWhereTheTableSays) {
  for (std::size_t i = 0; i < kLandmarkTable.size(); ++i) {
    const SurfaceLandmark& landmark = landmarks().all()[i];
    const auto& p = kLandmarkTable[i].position;
    EXPECT_LT(
        (landmark.position(testing::made_body().v_template.cast<double>()) - Vec3d(p[0], p[1], p[2])).norm(),
        5e-4)
        << landmark.name;
    EXPECT_NEAR(landmark.weight.sum(), 1, 1e-6);
  }
}

TEST(Landmarks, CarriedOverToAModelOfOtherProportions) {
  // Taller by a tenth along Y, arms longer along X: landmarks keep their places on the bones.
  BodyModel model = testing::made_body();
  for (Index v = 0; v < model.v_template.cols(); ++v) {
    model.v_template(1, v) *= 1.1f;
    model.v_template(0, v) *= 1.05f;
  }
  finish_model(model);
  const MeasuredModel measured(model);
  const LandmarkSet carried(measured);
  for (const SurfaceLandmark& landmark : landmarks().all()) {
    const Vec3d from = landmark.position(testing::made_body().v_template.cast<double>());
    const Vec3d wanted(1.05 * from.x(), 1.1 * from.y(), from.z());
    EXPECT_LT((carried.named(landmark.name).position(model.v_template.cast<double>()) - wanted).norm(), 0.025)
        << landmark.name;
  }
}

TEST(StandardPosture, StandsAsDescribedInAnyShape) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const BodyState state = standard_posture(measured_body(), testing::moved_state(seed, 0).betas);
    const Skeleton skeleton = pose_skeleton(testing::made_body(), state);
    const auto joint = [&](const char* segment) {
      return Vec3d(skeleton.joints.col(measured_body().joint(segment_named(segment))));
    };
    EXPECT_NEAR(joint("left_foot").x(), kAnkleHalfDistance, 1e-9);
    EXPECT_NEAR(joint("right_foot").x(), -kAnkleHalfDistance, 1e-9);
    for (const bool left : {true, false}) {
      const Vec3d arm =
          joint(left ? "left_forearm" : "right_forearm") - joint(left ? "left_arm" : "right_arm");
      EXPECT_NEAR(std::acos(-arm.normalized().y()), kArmAngle, 1e-9);
      EXPECT_GT((left ? 1 : -1) * arm.x(), 0);
      const int foot = measured_body().joint(segment_named(left ? "left_foot" : "right_foot"));
      EXPECT_LT((skeleton.global[static_cast<std::size_t>(foot)] - Mat3d::Identity()).norm(), 1e-9)
          << "feet flat";
    }
  }
}

TEST(Dimensions, AtLeastFortyEachDefined) {
  const auto all = dimensions_of(BodyState::rest(testing::made_body()), Posture::standing);
  std::set<std::string_view> names;
  for (const auto& [id, d] : all) {
    names.insert(d.name);
    EXPECT_GT(d.value_m, 0.02) << id;
    EXPECT_LT(d.value_m, 2.5) << id;
    EXPECT_FALSE(d.definition.empty()) << id;
    EXPECT_FALSE(d.uncertainty_m) << "nothing is known of a fit";
  }
  EXPECT_GE(names.size(), 40u);
}

TEST(Dimensions, LeftAndRightOfTheSymmetricBodyAgree) {
  const auto all = dimensions_of(BodyState::rest(testing::made_body()), Posture::standing);
  for (const auto& [id, d] : all) {
    if (d.side != "left") continue;
    const std::string other = id.substr(0, id.size() - 4) + "right";
    ASSERT_TRUE(all.count(other)) << other;
    EXPECT_NEAR(d.value_m, all.at(other).value_m, 5e-4) << id;
  }
}

TEST(Dimensions, TapesLieWhereTheyBelong) {
  const BodyState rest = BodyState::rest(testing::made_body());
  const Figure standing(measured_body(), standard_posture(measured_body(), rest.betas));
  const auto all = dimensions_of(rest, Posture::standing);
  const auto height = [&](const char* id) { return all.at(id).course.front().y(); };
  EXPECT_GT(height("upper_chest_girth"), height("bust_girth"));
  EXPECT_GT(height("bust_girth"), height("under_bust_girth"));
  EXPECT_GT(height("under_bust_girth"), height("waist_girth"));
  EXPECT_GT(height("waist_girth"), height("high_hip_girth"));
  EXPECT_GT(height("high_hip_girth"), height("hip_girth"));
  EXPECT_GT(height("hip_girth"), height("thigh_girth_left"));
  // No tape of the trunk runs round an arm: it stays within the shoulder joints' width and a hand's breadth.
  for (const char* id : {"upper_chest_girth", "chest_girth", "bust_girth", "waist_girth", "hip_girth"}) {
    for (const Vec3d& p : all.at(id).course) EXPECT_LT(std::abs(p.x()), 0.24) << id;
  }
  for (const Vec3d& p : all.at("thigh_girth_left").course) EXPECT_GT(p.x(), -0.005);
  for (const Vec3d& p : all.at("neck_girth").course) EXPECT_LT(std::abs(p.x()), 0.09);
  EXPECT_NEAR(all.at("stature").value_m,
              standing.vertices.row(1).maxCoeff() - standing.vertices.row(1).minCoeff(), 1e-12);
  // Round the neck's foot: larger than the neck, through the three landmarks, the same on both sides.
  const Dimension& neck_base = all.at("neck_base_girth");
  EXPECT_GT(neck_base.value_m, all.at("neck_girth").value_m);
  for (const char* name :
       {"cervicale", "left_neck_shoulder_point", "suprasternale", "right_neck_shoulder_point"}) {
    const Vec3d wanted = landmarks().named(name).position(standing.vertices);
    double nearest = 1;
    for (const Vec3d& p : neck_base.course) nearest = std::min(nearest, (p - wanted).norm());
    EXPECT_LT(nearest, 0.015) << name;
  }
  EXPECT_LE(all.at("waist_girth_minimum").value_m, all.at("waist_girth").value_m + 1e-9);
  EXPECT_GE(all.at("chest_girth").value_m, all.at("bust_girth").value_m - 1e-9);
}

TEST(Dimensions, StandardPostureDoesNotDependOnThePoseScanned) {
  BodyState sitting = testing::moved_state(8, 0.3), other = testing::moved_state(8, 0.1);
  other.betas = sitting.betas;
  const auto a = dimensions_of(sitting, Posture::standing), b = dimensions_of(other, Posture::standing);
  for (const auto& [id, d] : a) EXPECT_EQ(d.value_m, b.at(id).value_m) << id;
}

TEST(Dimensions, AsScannedEqualsStandardWhenScannedInTheStandardPosture) {
  const Eigen::VectorXd betas = testing::moved_state(3, 0).betas;
  BodyState state = standard_posture(measured_body(), betas);
  state.translation = Vec3d(1, 2, 3);
  state.rotation[0] = Eigen::AngleAxisd(0.8, Vec3d(1, 1, 0).normalized()).toRotationMatrix();
  const auto standard = dimensions_of(state, Posture::standing),
             scanned = dimensions_of(state, Posture::scanned);
  EXPECT_GT(scanned.size(), 60u);
  for (const auto& [id, d] : scanned) {
    EXPECT_NEAR(d.value_m, standard.at(id).value_m, 2e-6) << id;
    EXPECT_FALSE(d.course.empty()) << id;
  }
}

TEST(Dimensions, UncertaintyGrowsWithTheFitsError) {
  FitQuality good, bad;
  good.errors.fill(0.001);
  bad.errors.fill(0.030);
  const BodyState rest = BodyState::rest(testing::made_body());
  const auto a = dimensions_of(rest, Posture::standing, good),
             b = dimensions_of(rest, Posture::standing, bad);
  for (const auto& [id, d] : a) {
    ASSERT_TRUE(d.uncertainty_m) << id;
    EXPECT_GT(*b.at(id).uncertainty_m, *d.uncertainty_m) << id;
  }
}

}  // namespace
}  // namespace vitruvian
