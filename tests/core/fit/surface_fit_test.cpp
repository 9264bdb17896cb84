#include "fit/surface_fit.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

#include "core/fit/fit_fixtures.h"
#include "fit/landmark_fit.h"
#include "fit/refine.h"

namespace vitruvian {
namespace {

using testing::default_body;
using testing::default_fit_model;
using testing::joint_distance;
using testing::scan_of;
using testing::test_state;

constexpr int kScanPoints = 20000;

TEST(ScanTarget, AnyPrefixIsSpreadOverTheSurface) {
  const FitModel& model = default_fit_model();
  const ScanTarget scan = scan_of(model, test_state(0, 1), kScanPoints, 5);
  ASSERT_EQ(scan.points.cols(), kScanPoints);
  EXPECT_LT((scan.normals.colwise().norm().array() - 1).abs().maxCoeff(), 1e-4f);
  const Vec3f whole = scan.points.rowwise().mean(), part = scan.points.leftCols(700).rowwise().mean();
  EXPECT_LT((whole - part).norm(), 0.06f);
  const KdTree prefix(Points3f(scan.points.leftCols(700)));
  float farthest = 0;
  for (Index i = 0; i < scan.points.cols(); ++i) {
    farthest = std::max(farthest, prefix.nearest(scan.points.col(i)).squared_distance);
  }
  EXPECT_LT(std::sqrt(farthest), 0.2f);
}

TEST(ScanTarget, IsTheSameForTheSameSeed) {
  const FitModel& model = default_fit_model();
  const BodyState state = test_state(1, 1);
  EXPECT_EQ(scan_of(model, state, 500, 5).points, scan_of(model, state, 500, 5).points);
  EXPECT_NE(scan_of(model, state, 500, 5).points, scan_of(model, state, 500, 6).points);
}

TEST(ScoreFit, OfABodyAgainstItselfIsPerfect) {
  const FitModel& model = default_fit_model();
  const BodyState state = test_state(3, 2);
  PosedModel posed;
  posed.update(model, state);
  const FitScore score = score_fit(model, ScanTarget::from_points(posed.vertices, posed.normals), state);
  EXPECT_EQ(score.total(), 0);
  EXPECT_EQ(score.model_to_scan_p95, 0);
  EXPECT_EQ(score.scan_to_model_p95, 0);
  EXPECT_EQ(score.opposed_normals, 0);
}

TEST(ScoreFit, MeasuresAShiftAndTurnedNormals) {
  const FitModel& model = default_fit_model();
  const BodyState state = test_state(3, 2);
  PosedModel posed;
  posed.update(model, state);
  const FitScore turned = score_fit(model, ScanTarget::from_points(posed.vertices, -posed.normals), state);
  EXPECT_GT(turned.opposed_normals, 0.99);
  BodyState far = state;
  far.translation += Vec3d(100, 0, 0);
  const FitScore shifted = score_fit(model, ScanTarget::from_points(posed.vertices, posed.normals), far);
  EXPECT_NEAR(shifted.model_to_scan, 100, 2);
  EXPECT_NEAR(shifted.scan_to_model, 100, 2);
  EXPECT_GE(shifted.model_to_scan_p95, shifted.model_to_scan);
}

TEST(ScoreFit, TellsWhatIsMissingFromWhatIsTooMuch) {
  const FitModel& model = default_fit_model();
  const BodyState state = BodyState::rest(default_body());
  PosedModel posed;
  posed.update(model, state);
  // A scan without arms: the model's arms are far from it, but it is explained.
  std::vector<Index> kept;
  for (Index v = 0; v < posed.vertices.cols(); ++v) {
    if (std::abs(posed.vertices(0, v)) < 0.25f) kept.push_back(v);
  }
  Points3f points(3, static_cast<Index>(kept.size())), normals = points;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    points.col(static_cast<Index>(i)) = posed.vertices.col(kept[i]);
    normals.col(static_cast<Index>(i)) = posed.normals.col(kept[i]);
  }
  const FitScore score = score_fit(model, ScanTarget::from_points(points, normals), state);
  EXPECT_EQ(score.scan_to_model_p95, 0);
  EXPECT_GT(score.model_to_scan_p95, 0.1);
}

class SurfaceFit : public ::testing::TestWithParam<int> {};

TEST_P(SurfaceFit, ConvergesFromAPerturbedPose) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(GetParam(), 300 + GetParam());
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 9);
  BodyState state = testing::perturbed(truth, 0.15, 0.5, 400 + GetParam());
  state.translation += Vec3d(0.03, -0.02, 0.04);
  ASSERT_GT(joint_distance(default_body(), state, truth), 0.05);
  fit_surface(model, scan, FitSchedule::full(), {}, state, Execution(2));
  EXPECT_LT(joint_distance(default_body(), state, truth), 0.010);
  // Distances between samples have a floor of the sampling's own.
  EXPECT_LT(score_fit(model, scan, state).total(), 1.05 * score_fit(model, scan, truth).total());
}

TEST_P(SurfaceFit, ConvergesFromItsLandmarks) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(GetParam() + 1, 500 + GetParam());
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 10);
  const std::vector<LandmarkTarget> landmarks = testing::exact_landmarks(default_body(), truth);
  BodyState state = fit_landmarks(model, landmarks);
  fit_surface(model, scan, FitSchedule::full(), landmarks, state, Execution(2));
  EXPECT_LT(joint_distance(default_body(), state, truth), 0.010);
}

INSTANTIATE_TEST_SUITE_P(Poses, SurfaceFit, ::testing::Values(0, 12, 38));

TEST(SurfaceFitThreads, ChangeNothingThatMatters) {
  const FitModel& model = default_fit_model();
  const BodyState truth = test_state(8, 1);
  const ScanTarget scan = scan_of(model, truth, kScanPoints, 11);
  const BodyState start = testing::perturbed(truth, 0.1, 0.3, 2);
  const auto fitted = [&](int threads) {
    BodyState state = start;
    fit_surface(model, scan, FitSchedule::coarse(), {}, state, Execution(threads));
    return state;
  };
  const BodyState one = fitted(1), two = fitted(2), again = fitted(2);
  EXPECT_EQ(two.axis_angle(), again.axis_angle());
  EXPECT_EQ(two.betas, again.betas);
  EXPECT_EQ(two.translation, again.translation);
  EXPECT_LT(joint_distance(default_body(), one, two), 0.0005);
}

TEST(SurfaceFitCancel, StopsWithAnError) {
  const FitModel& model = default_fit_model();
  const ScanTarget scan = scan_of(model, test_state(8, 1), 2000, 11);
  // Far too long to end by itself.
  const FitSchedule endless{{{1000000, 300, 0.1, 0.1, 0.3, 0.03, 1.0, 0.05, 0.0, true}}};
  Execution execution(2);
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    execution.cancel();
  });
  BodyState state = test_state(8, 1);
  try {
    fit_surface(model, scan, endless, {}, state, execution);
    ADD_FAILURE() << "the fit was not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
  user.join();
}

/// Mean distance between equal vertices of two states, m.
double vertex_distance(const BodyState& a, const BodyState& b) {
  return (posed_vertices<double>(default_body(), a) - posed_vertices<double>(default_body(), b))
      .colwise()
      .norm()
      .mean();
}

/// A registered body as a scan of its own, with all search structures.
struct SelfScan {
  PosedModel posed;
  KdTree tree;
  ClosestPointOnMesh mesh;
  ScanTarget samples;

  explicit SelfScan(const BodyState& truth)
      : posed(pose(truth)),
        tree(posed.vertices),
        mesh(posed.vertices, default_body().faces),
        samples(scan_of(default_fit_model(), truth, kScanPoints, 21)) {}
  static PosedModel pose(const BodyState& state) {
    PosedModel result;
    result.update(default_fit_model(), state);
    return result;
  }
  /// Of the body's surface, by area, m.
  double mean_distance(const BodyState& state) const {
    const Points3f vertices = posed_vertices<float>(default_body(), state);
    double sum = 0;
    for (Index v = 0; v < vertices.cols(); ++v)
      sum += default_body().vertex_area[v] * mesh.query(vertices.col(v)).distance;
    return sum / default_body().vertex_area.sum();
  }
};

TEST(RefineFit, ReachesHalfAMillimetreOnItsOwnSurface) {
  for (const int pose : {2, 17, 44}) {
    SCOPED_TRACE(pose);
    const BodyState truth = test_state(pose, 600 + pose);
    const SelfScan scan(truth);
    BodyState state = testing::perturbed(truth, 0.02, 0.1, 700 + pose);
    const double before = vertex_distance(state, truth);
    refine_fit(default_fit_model(),
               {scan.posed.vertices, scan.posed.normals, default_body().faces, scan.tree, &scan.mesh},
               scan.samples, RefineSettings(), state, Execution(2));
    EXPECT_LT(scan.mean_distance(state), 0.0005);
    EXPECT_LT(vertex_distance(state, truth), std::min(0.0025, 0.5 * before));
    EXPECT_LT(joint_distance(default_body(), state, truth), 0.010);
  }
}

TEST(RefineFit, WorksOnABareCloud) {
  const BodyState truth = test_state(2, 602);
  const SelfScan scan(truth);
  BodyState state = testing::perturbed(truth, 0.02, 0.1, 702);
  const Faces none(3, 0);
  refine_fit(default_fit_model(),
             {scan.samples.points, scan.samples.normals, none, scan.samples.by_position, nullptr},
             scan.samples, RefineSettings(), state, Execution(2));
  EXPECT_LT(scan.mean_distance(state), 0.001);
}

TEST(RefineFit, LeavesAScanOutOfReachAlone) {
  const BodyState truth = test_state(2, 602);
  const SelfScan scan(truth);
  BodyState state = truth;
  state.translation += Vec3d(5, 0, 0);
  refine_fit(default_fit_model(),
             {scan.posed.vertices, scan.posed.normals, default_body().faces, scan.tree, &scan.mesh},
             scan.samples, RefineSettings(), state, Execution(1));
  EXPECT_TRUE(state.axis_angle().allFinite());
  EXPECT_LT((state.translation - truth.translation - Vec3d(5, 0, 0)).norm(), 0.05);
}

TEST(RefineFit, CanBeCancelled) {
  const BodyState truth = test_state(2, 602);
  const SelfScan scan(truth);
  Execution execution(1);
  execution.cancel();
  BodyState state = truth;
  try {
    refine_fit(default_fit_model(),
               {scan.posed.vertices, scan.posed.normals, default_body().faces, scan.tree, &scan.mesh},
               scan.samples, RefineSettings(), state, execution);
    ADD_FAILURE() << "the refinement was not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace vitruvian
