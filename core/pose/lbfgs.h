#pragma once

#include <Eigen/Core>
#include <functional>

namespace vitruvian {

/// Value of a function at x; writes its gradient, resized to x by the caller. May throw to stop the search
/// (cancel).
using DifferentiableFunction = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>;

struct LbfgsOptions {
  int history = 20;  ///< pairs of steps and gradient changes remembered
  int iterations = 300;
  double gradient_tolerance = 1e-9;   ///< stops when no entry of the gradient exceeds this
  double decrease_tolerance = 1e-12;  ///< stops when an iteration gains less than this share of |value|
  int line_search_evaluations = 30;
  double sufficient_decrease = 1e-4;  ///< Wolfe constant c1
  double curvature = 0.9;             ///< Wolfe constant c2
  /// Length of the very first step, in x's units; later ones start from the quasi-Newton step.
  double first_step = 1.0;
  /// Called after every iteration with its number (from 1) and the value it reached; may be empty.
  std::function<void(int iteration, double value)> each;
};

enum class LbfgsStop { gradient, decrease, iterations, line_search };

struct LbfgsResult {
  Eigen::VectorXd x;
  double value = 0;
  Eigen::VectorXd gradient;
  int iterations = 0;
  int evaluations = 0;
  LbfgsStop stop = LbfgsStop::iterations;
};

/// Limited-memory BFGS with a strong-Wolfe line search (Nocedal and Wright 2006, algorithms 7.4, 3.5
/// and 3.6). Points where the function is not finite are treated as steps too long. The value never rises.
/// @throws Error(internal) when the function is not finite at the start.
LbfgsResult minimize_lbfgs(const DifferentiableFunction& function, Eigen::VectorXd start,
                           const LbfgsOptions& options = {});

}  // namespace vitruvian
