#include "fit/paper_solver.h"

#include <gtest/gtest.h>

#include "core/fit/fit_fixtures.h"
#include "core/numeric_jacobian.h"

namespace vitruvian {
namespace {

using testing::default_body;
using testing::default_fit_model;

Points3f scan_points(const BodyState& state, int count, std::uint32_t seed) {
  return testing::scan_of(default_fit_model(), state, count, seed).points;
}

double mean_vertex_distance(const BodyState& a, const BodyState& b) {
  return (posed_vertices<double>(default_body(), a) - posed_vertices<double>(default_body(), b))
      .colwise()
      .norm()
      .mean();
}

TEST(FitChamfer, BringsANearbyBodyOntoTheScan) {
  const BodyState truth = testing::test_state(3, 5);
  const BodyState start = testing::perturbed(truth, 0.08, 0.2, 6);
  const ChamferDistance distance(scan_points(truth, 3000, 7), {}, {});
  PaperSolverOptions solver;
  solver.iterations = solver.adam_iterations = 150;
  std::vector<double> energies;
  const PaperFit fit = fit_chamfer(default_body(), 32, distance, start, {}, solver, Execution(2),
                                   [&](int, double energy) { energies.push_back(energy); });
  EXPECT_EQ(fit.adam_iterations, 150);
  EXPECT_EQ(fit.lbfgs_iterations, 0);
  ASSERT_EQ(energies.size(), 150u);
  EXPECT_EQ(energies.front(), fit.initial_energy);
  EXPECT_LT(fit.energy, 0.6 * fit.initial_energy);
  EXPECT_LT(mean_vertex_distance(fit.state, truth), 0.6 * mean_vertex_distance(start, truth));
}

TEST(FitChamfer, HybridGoesOnWithLbfgs) {
  const BodyState truth = testing::test_state(3, 5);
  const BodyState start = testing::perturbed(truth, 0.08, 0.2, 6);
  const ChamferDistance distance(scan_points(truth, 3000, 7), {}, {true, 0});
  PaperSolverOptions solver;
  solver.iterations = 60;
  solver.adam_iterations = 20;
  int calls = 0;
  const PaperFit fit = fit_chamfer(default_body(), 32, distance, start, {}, solver, Execution(2),
                                   [&](int iteration, double) { EXPECT_EQ(iteration, ++calls); });
  EXPECT_EQ(fit.adam_iterations, 20);
  EXPECT_GT(fit.lbfgs_iterations, 0);
  EXPECT_EQ(calls, 20 + fit.lbfgs_iterations);
  solver.iterations = solver.adam_iterations = 20;
  const PaperFit adam = fit_chamfer(default_body(), 32, distance, start, {}, solver, Execution(2));
  EXPECT_LT(fit.energy, adam.energy) << "L-BFGS never makes it worse than what Adam left";
}

// Strong regularisers hold the parameters, the published weak ones let them go.
TEST(FitChamfer, RegularisersAnchorAtTheStart) {
  const BodyState truth = testing::test_state(3, 5);
  const BodyState start = testing::perturbed(truth, 0.08, 0.2, 6);
  const ChamferDistance distance(scan_points(truth, 2000, 7), {}, {});
  PaperSolverOptions solver;
  solver.iterations = solver.adam_iterations = 60;
  ChamferFitOptions strong;
  strong.pose_weight = strong.shape_weight = 1e4;
  const ParametricBody body(default_body(), 32);
  const auto moved = [&](const ChamferFitOptions& weights) {
    const PaperFit fit = fit_chamfer(default_body(), 32, distance, start, weights, solver, Execution(2));
    return (body.numbers_of(fit.state) - body.numbers_of(start)).tail(body.size() - 3).norm();
  };
  EXPECT_LT(moved(strong), 0.2 * moved({}));
}

// Matches to its own vertices: the true body is the known optimum, with energy 0.
TEST(FitCorrespondences, FindsTheKnownOptimum) {
  const BodyState truth = testing::test_state(8, 9);
  const Points3f scan = posed_vertices<float>(default_body(), truth);
  std::vector<int> matches(static_cast<std::size_t>(scan.cols()));
  for (std::size_t v = 0; v < matches.size(); ++v) matches[v] = static_cast<int>(v);
  const BodyState start = testing::perturbed(truth, 0.1, 0.3, 10);
  PaperSolverOptions solver;
  solver.iterations = 800;
  solver.adam_iterations = 20;
  const PaperFit fit = fit_correspondences(default_body(), 32, scan, matches, start, solver, Execution(2));
  EXPECT_LT(mean_vertex_distance(fit.state, truth), 1e-3) << "after " << fit.lbfgs_iterations;
  EXPECT_LT(fit.energy, 1e-3 * fit.initial_energy);
  // 1/(3N) sum of squares, of the start.
  const double mean_square =
      (posed_vertices<double>(default_body(), start) - scan.cast<double>()).squaredNorm() /
      (3.0 * scan.cols());
  EXPECT_NEAR(fit.initial_energy, mean_square, 1e-5 * mean_square);
}

TEST(FitCorrespondences, StopsWhenCancelled) {
  const BodyState state = testing::test_state(8, 9);
  Execution execution(1);
  const std::vector<int> matches(static_cast<std::size_t>(default_body().vertex_count()), 0);
  const auto cancel = [&](int iteration, double) {
    if (iteration == 3) execution.cancel();
  };
  EXPECT_THROW(
      fit_correspondences(default_body(), 32, Points3f::Zero(3, 1), matches, state, {}, execution, cancel),
      Error);
}

}  // namespace
}  // namespace vitruvian
