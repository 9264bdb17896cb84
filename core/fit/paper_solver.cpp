#include "fit/paper_solver.h"

#include <algorithm>

#include "base/error.h"
#include "fit/adam.h"
#include "pose/lbfgs.h"

namespace vitruvian {
namespace {

/// Adam, then L-BFGS from where it ended.
PaperFit minimize(const DifferentiableFunction& function, const ParametricBody& body, Eigen::VectorXd x,
                  const PaperSolverOptions& solver, const Execution& execution, const EnergyCallback& each) {
  PaperFit fit;
  int done = 0;
  const DifferentiableFunction checked = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
    execution.check();
    return function(at, gradient);
  };
  {
    Eigen::VectorXd gradient;
    fit.initial_energy = checked(x, gradient);
  }
  AdamOptions adam;
  adam.iterations = std::clamp(solver.adam_iterations, 0, solver.iterations);
  adam.step = solver.adam_step;
  const AdamResult first = minimize_adam(checked, std::move(x), adam, [&](int, double energy) {
    if (each) each(++done, energy);
  });
  fit.adam_iterations = first.iterations;
  fit.energy = first.value;
  Eigen::VectorXd best = first.x;
  if (const int rest = solver.iterations - adam.iterations; rest > 0) {
    LbfgsOptions search;
    search.iterations = rest;
    // No early stop is published: only a line search without a gain ends it.
    search.gradient_tolerance = 0;
    search.decrease_tolerance = 0;
    search.first_step = solver.adam_step;
    search.each = [&](int, double energy) {
      if (each) each(++done, energy);
    };
    const LbfgsResult second = minimize_lbfgs(checked, std::move(best), search);
    fit.lbfgs_iterations = second.iterations;
    fit.energy = second.value;
    best = second.x;
  }
  fit.state = body.state_of(best);
  return fit;
}

}  // namespace

PaperFit fit_chamfer(const BodyModel& model, int betas, const ChamferDistance& distance,
                     const BodyState& start, const ChamferFitOptions& weights,
                     const PaperSolverOptions& solver, const Execution& execution,
                     const EnergyCallback& each) {
  ParametricBody body(model, betas);
  const Eigen::VectorXd origin = body.numbers_of(start);
  const Index angles = 3 * model.joint_count();
  Points3f by_vertex;
  const auto energy = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    const double data = distance(body.pose(x), by_vertex, execution);
    body.pull_back(by_vertex, gradient, execution);
    const Eigen::VectorXd pose = (x - origin).segment(3, angles), shape = (x - origin).tail(body.betas());
    gradient.segment(3, angles) += 2 * weights.pose_weight * pose;
    gradient.tail(body.betas()) += 2 * weights.shape_weight * shape;
    return data + weights.pose_weight * pose.squaredNorm() + weights.shape_weight * shape.squaredNorm();
  };
  return minimize(energy, body, origin, solver, execution, each);
}

PaperFit fit_correspondences(const BodyModel& model, int betas, const Points3f& scan,
                             std::span<const int> matches, const BodyState& start,
                             const PaperSolverOptions& solver, const Execution& execution,
                             const EnergyCallback& each) {
  if (static_cast<int>(matches.size()) != model.vertex_count())
    throw Error(ErrorCode::internal, "point-to-point fit: one match a template vertex expected");
  ParametricBody body(model, betas);
  Points3f target(3, model.vertex_count());
  for (Index v = 0; v < target.cols(); ++v) target.col(v) = scan.col(matches[static_cast<std::size_t>(v)]);
  const auto numbers = static_cast<double>(target.size());
  Points3f by_vertex;
  const auto energy = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    by_vertex = body.pose(x) - target;
    const double sum = by_vertex.cast<double>().squaredNorm();
    by_vertex *= static_cast<float>(2 / numbers);
    body.pull_back(by_vertex, gradient, execution);
    return sum / numbers;
  };
  return minimize(energy, body, body.numbers_of(start), solver, execution, each);
}

}  // namespace vitruvian
