#include "fit/fit_trace.h"

#include <gtest/gtest.h>

#include "core/fit/fit_fixtures.h"
#include "fit/landmark_fit.h"
#include "fit/surface_fit.h"

namespace vitruvian {
namespace {

using namespace testing;

constexpr std::uint32_t kSeed = 11;

/// A short schedule with both kinds of neighbour search.
FitSchedule short_schedule() {
  FitSchedule schedule = FitSchedule::full();
  schedule.stages[0].iterations = 3;
  schedule.stages[1].iterations = 2;
  schedule.stages[2].iterations = 1;
  return schedule;
}

class Trace : public ::testing::Test {
 protected:
  const FitModel& model_ = default_fit_model();
  BodyState truth_ = test_state(3, kSeed);
  ScanTarget scan_ = scan_of(model_, truth_, 4000, kSeed);
  std::vector<LandmarkTarget> landmarks_ = exact_landmarks(model_.body, truth_);
  Execution execution_{1};
};

TEST_F(Trace, ChangesNothingOfTheFitItWatches) {
  BodyState plain = perturbed(truth_, 0.15, 0.5, kSeed), watched = plain;
  fit_surface(model_, scan_, short_schedule(), landmarks_, plain, execution_);
  FitTrace trace(model_);
  fit_surface(model_, scan_, short_schedule(), landmarks_, watched, execution_, trace.observer());
  trace.finish(watched);
  EXPECT_EQ(plain.axis_angle(), watched.axis_angle());
  EXPECT_EQ(plain.betas, watched.betas);
  EXPECT_EQ(plain.translation, watched.translation);
  ASSERT_EQ(trace.steps().size(), 7u);
  EXPECT_EQ(trace.steps().back().state.betas, watched.betas);
  EXPECT_EQ(trace.steps()[3].stage, 1);
}

TEST_F(Trace, JointsComeNearerAndPairsLieOnBothSurfaces) {
  BodyState state = fit_landmarks(model_, landmarks_);
  FitTrace trace(model_);
  fit_surface(model_, scan_, FitSchedule::full(), landmarks_, state, execution_, trace.observer());
  trace.finish(state);
  const Eigen::Matrix3Xf joints = pose_skeleton(model_.body, truth_).joints.cast<float>();
  const auto away = [&](const TraceStep& step) { return (step.joints - joints).colwise().norm().maxCoeff(); };
  EXPECT_LT(away(trace.steps().back()), 0.3f * away(trace.steps().front()));
  EXPECT_LT(trace.steps().back().model_to_scan_m, trace.steps().front().model_to_scan_m);
  for (const TraceStep& step : trace.steps()) {
    if (&step == &trace.steps().back()) continue;
    ASSERT_GT(step.pairs_of_model, 0);
    ASSERT_GT(step.pairs.cols(), step.pairs_of_model);
    PosedModel posed;
    posed.update(model_, step.state);
    const KdTree vertices(posed.vertices);
    for (Index i = 0; i < step.pairs.cols(); ++i) {
      EXPECT_LT(vertices.nearest(step.pairs.col(i).head<3>()).squared_distance, 1e-10f);
      EXPECT_LT(scan_.by_position.nearest(step.pairs.col(i).tail<3>()).squared_distance, 1e-10f);
    }
  }
}

TEST_F(Trace, FromOneDirectionNothingIsPulledByTheScan) {
  FitSchedule schedule = short_schedule();
  for (FitStage& stage : schedule.stages) stage.from_scan = false;
  BodyState state = perturbed(truth_, 0.1, 0.3, kSeed);
  FitTrace trace(model_);
  fit_surface(model_, scan_, schedule, {}, state, execution_, trace.observer());
  for (const TraceStep& step : trace.steps()) {
    EXPECT_EQ(step.energy.scan_to_model, 0);
    EXPECT_GT(step.energy.model_to_scan, 0);
    EXPECT_EQ(step.pairs.cols(), step.pairs_of_model);
  }
}

TEST_F(Trace, IsBounded) {
  FitTrace trace(model_, 4, 10);
  BodyState state = fit_landmarks(model_, landmarks_, {}, trace.observer());
  fit_surface(model_, scan_, short_schedule(), landmarks_, state, execution_, trace.observer());
  trace.finish(state);
  ASSERT_EQ(trace.steps().size(), 4u);
  EXPECT_EQ(trace.steps()[0].stage, -1);
  EXPECT_EQ(trace.steps().back().state.betas, state.betas);
  for (const TraceStep& step : trace.steps()) EXPECT_LE(step.pairs.cols(), 10);
}

/// The priors' energies are those whose halved gradient the normal equations hold.
TEST_F(Trace, EnergiesBelongToTheNormalEquations) {
  BodyState state = perturbed(truth_, 0.6, 1, kSeed);  // beyond some limits
  const auto energy_at = [&](const BodyState& at) {
    const Skeleton skeleton = pose_skeleton(model_.body, at);
    const FitEnergy e =
        energy_of(model_, {0, 0.1, at, skeleton, nullptr, {}, {}, {}, 0.03, 0, 0.7, 0.4, 0.3});
    EXPECT_GT(e.joint_limits, 0);
    return e.pose_prior + e.joint_limits + e.shape_prior;
  };
  PosedModel posed;
  posed.update(model_, state);
  NormalEquations equations(model_);
  equations.add_pose_prior(state, posed, 0.7, 0.4);
  equations.add_shape_prior(state, 0.3);
  Random random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::VectorXd direction(model_.unknowns());
    for (Index i = 0; i < direction.size(); ++i) direction[i] = random.normal();
    constexpr double kStep = 1e-5;
    BodyState ahead = state, behind = state;
    apply_update(model_.body, posed.skeleton, kStep * direction, ahead);
    apply_update(model_.body, posed.skeleton, -kStep * direction, behind);
    const double slope = (energy_at(ahead) - energy_at(behind)) / (2 * kStep);
    EXPECT_NEAR(slope, 2 * equations.gradient().dot(direction), 1e-4 * std::abs(slope) + 1e-6);
  }
}

}  // namespace
}  // namespace vitruvian
