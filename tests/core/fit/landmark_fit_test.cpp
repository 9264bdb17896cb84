#include "fit/landmark_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "core/fit/fit_fixtures.h"
#include "fit/hypotheses.h"

namespace vitruvian {
namespace {

using testing::default_body;
using testing::default_fit_model;
using testing::exact_landmarks;
using testing::test_state;

TEST(FitModel, AnyPrefixOfTheOrderIsSpreadByArea) {
  const FitModel& model = default_fit_model();
  std::vector<int> sorted = model.order;
  std::sort(sorted.begin(), sorted.end());
  for (int v = 0; v < model.body.vertex_count(); ++v) ASSERT_EQ(sorted[v], v);
  std::array<double, 24> area{}, share{};
  const double all = model.body.vertex_area.sum();
  for (int v = 0; v < model.body.vertex_count(); ++v)
    area[model.body.segment[v]] += model.body.vertex_area[v] / all;
  for (int i = 0; i < 700; ++i) share[model.body.segment[model.order[i]]] += 1 / 700.0;
  for (int s = 0; s < 24; ++s) EXPECT_NEAR(share[s], area[s], 0.035) << kSegmentNames[s];
}

TEST(FitModel, TakesAtMostTheBetasThatThereAre) {
  EXPECT_EQ(FitModel(default_body(), testing::shipped_prior(), Gender::male, 10).betas, 10);
  EXPECT_EQ(FitModel(default_body(), testing::shipped_prior(), Gender::male, 1000).betas,
            default_body().beta_count());
  EXPECT_EQ(FitModel(default_body(), testing::shipped_prior(), Gender::male, 0).betas,
            default_body().beta_count());
}

TEST(MirroredLandmark, IsAnInvolutionThatKeepsTheNoseOnly) {
  for (int l = 0; l < 33; ++l) {
    const int partner = mirrored_landmark(l);
    EXPECT_TRUE(partner >= 0 && partner < 33);
    EXPECT_EQ(mirrored_landmark(partner), l);
    EXPECT_EQ(partner == l, l == 0) << l;
  }
  // BlazePose: 2 left eye, 5 right eye; 9 mouth left, 10 mouth right; 31 left foot, 32 right foot.
  EXPECT_EQ(mirrored_landmark(2), 5);
  EXPECT_EQ(mirrored_landmark(9), 10);
  EXPECT_EQ(mirrored_landmark(31), 32);
}

TEST(PlaceByTorso, UndoesARigidMotionExactly) {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    const BodyState truth = test_state(trial, 100 + trial);
    const std::vector<LandmarkTarget> landmarks = exact_landmarks(default_body(), truth);
    BodyState moved = truth;
    const Vec3d axis = Vec3d(random.normal(), random.normal(), random.normal()).normalized();
    moved.rotation[0] =
        Eigen::AngleAxisd(random.uniform(-3.1, 3.1), axis).toRotationMatrix() * moved.rotation[0];
    moved.translation += Vec3d(random.normal(), random.normal(), random.normal());
    place_by_torso(default_fit_model(), landmarks, moved);
    EXPECT_LT((moved.rotation[0] - truth.rotation[0]).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((moved.translation - truth.translation).norm(), 1e-9);
    EXPECT_LT(landmark_error(pose_skeleton(default_body(), moved), landmarks), 1e-9);
  }
}

TEST(PlaceByTorso, NeverMirrors) {
  const BodyState truth = test_state(0, 1);
  std::vector<LandmarkTarget> landmarks = exact_landmarks(default_body(), truth);
  for (LandmarkTarget& l : landmarks) l.target[0] *= -1;
  BodyState placed = truth;
  place_by_torso(default_fit_model(), landmarks, placed);
  EXPECT_NEAR(placed.rotation[0].determinant(), 1, 1e-9);
}

TEST(PlaceByTorso, UnusedLandmarksMayHoldAnything) {
  const BodyState truth = test_state(1, 1);
  std::vector<LandmarkTarget> landmarks = exact_landmarks(default_body(), truth);
  for (LandmarkTarget& l : landmarks) {
    if (l.joint != 1) continue;
    l.weight = 0;
    l.target.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  BodyState moved = truth;
  moved.translation += Vec3d(1, 2, 3);
  place_by_torso(default_fit_model(), landmarks, moved);
  EXPECT_LT((moved.translation - truth.translation).norm(), 1e-9);
  EXPECT_LT(landmark_error(pose_skeleton(default_body(), moved), landmarks), 1e-9);
}

TEST(PlaceByTorso, WithoutTorsoLandmarksNothingMoves) {
  const BodyState truth = test_state(2, 1);
  BodyState same = truth;
  place_by_torso(default_fit_model(), {}, same);
  EXPECT_EQ(same.translation, truth.translation);
  EXPECT_EQ(same.rotation[0], truth.rotation[0]);
}

TEST(FitLandmarks, RecoversThePoseFromExactLandmarks) {
  std::vector<double> errors;
  for (int pose = 0; pose < 60; ++pose) {
    SCOPED_TRACE(pose);
    const BodyState truth = test_state(pose, 200 + pose);
    const std::vector<LandmarkTarget> landmarks = exact_landmarks(default_body(), truth);
    const BodyState found = fit_landmarks(default_fit_model(), landmarks);
    EXPECT_LT(landmark_error(pose_skeleton(default_body(), found), landmarks), 0.02);
    errors.push_back(testing::joint_distance(default_body(), found, truth));
  }
  // Landmarks say little about spine and collars, and the prior pulls: joints are near, not exact.
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[30], 0.06);
  EXPECT_LT(errors[57], 0.12);
}

TEST(FitLandmarks, OneWildLandmarkIsOutvoted) {
  const BodyState truth = test_state(5, 7);
  std::vector<LandmarkTarget> landmarks = exact_landmarks(default_body(), truth);
  const BodyState clean = fit_landmarks(default_fit_model(), landmarks);
  for (LandmarkTarget& l : landmarks) {
    if (l.landmark == 15) l.target += Vec3d(0.5, 0.8, -0.6);
  }
  const BodyState found = fit_landmarks(default_fit_model(), landmarks);
  EXPECT_LT(testing::joint_distance(default_body(), found, clean), 0.06);
}

TEST(FitLandmarks, WithoutLandmarksGivesTheLikeliestBody) {
  const BodyState found = fit_landmarks(default_fit_model(), {});
  EXPECT_TRUE(found.axis_angle().allFinite());
  EXPECT_LT((found.betas - default_fit_model().shape_prior.mean).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(found.translation.norm(), 1e-6);
}

}  // namespace
}  // namespace vitruvian
