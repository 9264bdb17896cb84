#include "fit/hypotheses.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/fit/fit_fixtures.h"
#include "fit/extremity_flip.h"
#include "fit/limb_search.h"

namespace vitruvian {
namespace {

using testing::default_body;
using testing::default_fit_model;
using testing::exact_landmarks;
using testing::joint_distance;
using testing::scan_of;
using testing::test_state;

constexpr int kScanPoints = 20000;

std::vector<LandmarkTarget> with_exchanged(std::vector<LandmarkTarget> landmarks, int first, int last) {
  const std::vector<LandmarkTarget> before = landmarks;
  for (LandmarkTarget& l : landmarks) {
    if (l.landmark < first || l.landmark > last) continue;
    for (const LandmarkTarget& other : before) {
      if (other.landmark == mirrored_landmark(l.landmark)) l.target = other.target;
    }
  }
  return landmarks;
}

class LimbSearch : public ::testing::TestWithParam<int> {};

// The limb is put where the scan has none; the library must bring it near enough for a fit to finish.
TEST_P(LimbSearch, BringsBackALimbThatWasFoldedAway) {
  const FitModel& model = default_fit_model();
  const int limb = GetParam();
  const LimbChain& chain = kLimbs[limb];
  for (const int pose : {0, 40}) {
    SCOPED_TRACE(pose);
    const BodyState truth = test_state(pose, 800 + pose);
    const ScanTarget scan = scan_of(model, truth, kScanPoints, 31);
    BodyState folded = truth;
    // Arms up behind the head, legs kicked up in front, where these poses have none.
    folded.rotation[chain.root] =
        Eigen::AngleAxisd(limb < 2 ? 2.2 : -2.0,
                          limb < 2 ? Vec3d(0, limb == 0 ? -1 : 1, 0.7).normalized() : Vec3d::UnitX())
            .toRotationMatrix() *
        folded.rotation[chain.root];
    ASSERT_GT(joint_distance(default_body(), folded, truth), 0.2);
    const std::vector<BodyState> found = search_limb(model, scan, folded, limb, 2);
    ASSERT_GE(found.size(), 1u);
    ASSERT_LE(found.size(), 2u);
    double nearest = 1e9, fitted = 1e9;
    for (const BodyState& candidate : found) {
      nearest = std::min(nearest, joint_distance(default_body(), candidate, truth));
      BodyState state = candidate;
      fit_surface(model, scan, FitSchedule::after_limb_search(), {}, state, Execution(2));
      fit_surface(model, scan, FitSchedule::polish(), {}, state, Execution(2));
      fitted = std::min(fitted, joint_distance(default_body(), state, truth));
      // Only this limb may have been touched.
      for (int j = 0; j < 24; ++j) {
        const bool own = j == chain.root || j == chain.middle || j == chain.end || j == chain.tip;
        if (!own) {
          EXPECT_EQ(candidate.rotation[j], folded.rotation[j]);
        }
      }
    }
    EXPECT_LT(nearest, 0.25);
    EXPECT_LT(fitted, 0.015);
  }
}

INSTANTIATE_TEST_SUITE_P(Limbs, LimbSearch, ::testing::Range(0, 4));

TEST(LimbSearchCandidates, AreDistinctAndReproducible) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(7, 3);
  const ScanTarget scan = scan_of(model, truth, 5000, 32);
  const std::vector<BodyState> found = search_limb(model, scan, truth, 0, 4);
  const std::vector<BodyState> again = search_limb(model, scan, truth, 0, 4);
  ASSERT_EQ(found.size(), again.size());
  const int root = kLimbs[0].root;
  for (std::size_t a = 0; a < found.size(); ++a) {
    EXPECT_EQ(found[a].rotation[root], again[a].rotation[root]);
    for (std::size_t b = 0; b < a; ++b) {
      const Mat3d between = found[a].rotation[root].transpose() * found[b].rotation[root];
      EXPECT_GE(Eigen::AngleAxisd(between).angle(), 0.5);
    }
  }
  EXPECT_TRUE(search_limb(model, scan, truth, 0, 1).size() == 1);
}

TEST(FitHypotheses, GoodLandmarksNeedNoSecondStart) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(10, 4);
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 33);
  const HypothesisResult result = fit_hypotheses(model, scan, exact_landmarks(default_body(), truth), {},
                                                 HypothesisSettings(), Execution(2));
  EXPECT_FALSE(result.bad);
  EXPECT_EQ(result.start, "landmarks");
  EXPECT_EQ(result.refits, 0);
  EXPECT_EQ(result.repairs, 0);
  EXPECT_EQ(result.runner_up_gap, 0);
  EXPECT_LT(joint_distance(default_body(), result.state, truth), 0.010);
}

/// How many of the poses come out right from landmarks exchanged in [first, 32].
int mended(const std::vector<int>& poses, int first) {
  const FitModel& model = default_fit_model();
  int right = 0;
  for (const int pose : poses) {
    const BodyState truth = test_state(pose, 900 + pose);
    const ScanTarget scan = scan_of(model, truth, kScanPoints, 34);
    const auto landmarks = with_exchanged(exact_landmarks(default_body(), truth), first, 32);
    const HypothesisResult result =
        fit_hypotheses(model, scan, landmarks, {}, HypothesisSettings(), Execution(2));
    EXPECT_LE(result.refits, HypothesisSettings().refit_budget);
    EXPECT_GT(result.refits, 0) << "pose " << pose << " was no test at all";
    right += !result.bad && joint_distance(default_body(), result.state, truth) < 0.020;
  }
  return right;
}

// Crossed limbs can explain a scan of legs close together nearly as well as right ones, so a rare pose may
// stay wrong.
TEST(FitHypotheses, MendExchangedLegs) { EXPECT_GE(mended({0, 4, 8}, 25), 2); }

TEST(FitHypotheses, MendEverythingExchanged) { EXPECT_GE(mended({0}, 1), 1); }

TEST(FitHypotheses, UseThePlainTriangulationWhenItIsTheRightOne) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(15, 5);
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 35);
  const auto plain = exact_landmarks(default_body(), truth);
  HypothesisSettings settings;
  settings.repair_rounds = 0;
  const HypothesisResult result =
      fit_hypotheses(model, scan, with_exchanged(plain, 1, 32), plain, settings, Execution(2));
  EXPECT_EQ(result.start, "plain triangulation");
  EXPECT_FALSE(result.bad);
  EXPECT_EQ(result.refits, 1);
  EXPECT_GT(result.runner_up_gap, 0);
}

/// A state with one foot (limb 2, 3) or hand (0, 1) turned half round its shank or forearm.
BodyState with_turned(BodyState state, int limb) {
  const Skeleton skeleton = pose_skeleton(default_body(), state);
  const LimbChain& chain = kLimbs[limb];
  const Vec3d bone = skeleton.rest_joints.col(chain.end) - skeleton.rest_joints.col(chain.middle);
  state.rotation[chain.end] =
      Eigen::AngleAxisd(3.1, bone.normalized()).toRotationMatrix() * state.rotation[chain.end];
  return state;
}

double angle_at(const BodyState& a, const BodyState& b, int joint) {
  return Eigen::AngleAxisd(Mat3d(a.rotation[joint].transpose() * b.rotation[joint])).angle();
}

TEST(Extremities, OnlyTheTurnedOneMisfits) {
  const FitModel& model = default_fit_model();
  for (int limb = 0; limb < 4; ++limb) {
    SCOPED_TRACE(limb);
    const BodyState truth = test_state(10 + limb, 40 + limb);
    const ScanTarget scan = scan_of(model, truth, kScanPoints, 36);
    const BodyState turned = with_turned(truth, limb);
    PosedModel posed;
    posed.update(model, turned);
    const double limit = HypothesisSettings().bad_bare_extremity * score_fit(model, scan, turned).typical;
    for (int other = 0; other < 4; ++other) {
      const double misfit = extremity_misfit(model, scan, posed, other);
      if (other == limb) {
        EXPECT_GT(misfit, limit);
      } else {
        EXPECT_LT(misfit, 0.014);
      }
    }
    EXPECT_TRUE(turned_extremities(model, scan, truth, limit).empty());
    const std::vector<BodyState> found = turned_extremities(model, scan, turned, limit);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_LT(angle_at(found[0], truth, kLimbs[limb].end), 0.1);
    EXPECT_GT(score_fit(model, scan, turned).total(), score_fit(model, scan, truth).total() + 0.001);
  }
}

// An arm away from the scan must not make a bare body pass for a clothed one, whose limits are wider.
TEST(FitScore, ALostArmLeavesTheTypicalDistance) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(20, 50);
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 38);
  BodyState lost = truth;
  lost.rotation[kLimbs[0].root] = Eigen::AngleAxisd(2.2, Vec3d(0, -1, 0.7).normalized()).toRotationMatrix() *
                                  lost.rotation[kLimbs[0].root];
  ASSERT_GT(joint_distance(default_body(), lost, truth), 0.2);
  const HypothesisSettings settings;
  const FitScore right = score_fit(model, scan, truth), wrong = score_fit(model, scan, lost);
  EXPECT_LT(right.typical, 0.9 * settings.bare_typical);
  EXPECT_LT(right.model_to_scan_p95, settings.bad_bare_model_to_scan_p95);
  EXPECT_LT(wrong.typical, settings.bare_typical);
  EXPECT_GT(wrong.model_to_scan_p95, settings.bad_bare_model_to_scan_p95);
}

// Heel and toes exchanged: the joints stay nearly right, the foot points backward.
TEST(FitHypotheses, MendAFootTurnedBackToFront) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(10, 4);
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 37);
  const auto landmarks = exact_landmarks(default_body(), with_turned(truth, 3));
  const HypothesisResult result =
      fit_hypotheses(model, scan, landmarks, {}, HypothesisSettings(), Execution(2));
  EXPECT_FALSE(result.bad);
  EXPECT_LT(angle_at(result.state, truth, kLimbs[3].end), 0.2);
  EXPECT_LT(joint_distance(default_body(), result.state, truth), 0.020);
}

// A scan of something else can never be explained: everything is tried, within the budget.
TEST(FitHypotheses, KeepToTheirBudget) {
  const FitModel& model = default_fit_model();
  const BodyState body = test_state(15, 5);
  Points3f points(3, 3000), normals;
  Random random(1);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] = static_cast<float>(random.normal());
  points.colwise().normalize();
  normals = points;
  const ScanTarget ball = ScanTarget::from_points(points.colwise() + body.translation.cast<float>(), normals);
  const auto landmarks = exact_landmarks(default_body(), body);
  for (const int budget : {0, 3}) {
    HypothesisSettings settings;
    settings.refit_budget = budget;
    const HypothesisResult result = fit_hypotheses(model, ball, landmarks, landmarks, settings, Execution(2));
    EXPECT_TRUE(result.bad);
    EXPECT_EQ(result.refits, budget);
    EXPECT_TRUE(result.state.axis_angle().allFinite());
  }
}

TEST(FitHypotheses, GiveTheSameBytesAgain) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(3, 903);
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 34);
  const auto landmarks = with_exchanged(exact_landmarks(default_body(), truth), 25, 32);
  HypothesisSettings settings;
  settings.refit_budget = 9;
  const auto run = [&] { return fit_hypotheses(model, scan, landmarks, {}, settings, Execution(2)); };
  const HypothesisResult first = run(), second = run();
  EXPECT_EQ(first.state.axis_angle(), second.state.axis_angle());
  EXPECT_EQ(first.state.betas, second.state.betas);
  EXPECT_EQ(first.start, second.start);
  EXPECT_EQ(first.refits, second.refits);
}

TEST(FitHypotheses, CanBeCancelled) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(3, 903);
  const ScanTarget scan = scan_of(model, truth, 3000, 34);
  Execution whole(2), part(2, &whole);
  whole.cancel();
  try {
    fit_hypotheses(model, scan, exact_landmarks(default_body(), truth), {}, HypothesisSettings(), part);
    ADD_FAILURE() << "the fit was not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace vitruvian
