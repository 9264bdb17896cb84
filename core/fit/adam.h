#pragma once

#include <Eigen/Core>
#include <functional>

#include "pose/lbfgs.h"

namespace vitruvian {

/// Constants of Adam (Kingma and Ba 2015, algorithm 1); the step is the paper's (section 4), the others are
/// the method's own defaults.
struct AdamOptions {
  int iterations = 6000;
  double step = 0.005;
  double first_decay = 0.9;     ///< beta_1, of the gradient's running mean
  double second_decay = 0.999;  ///< beta_2, of its square's
  double epsilon = 1e-8;
};

struct AdamResult {
  Eigen::VectorXd x;
  double value = 0;  ///< at x
  int iterations = 0;
};

/// Runs all iterations; there is no stopping rule, and the last x is the result.
/// @param each  called after every iteration with its number (from 1) and the value before its step.
/// @throws Error(internal) when the value or the gradient is not finite; what `function` throws.
AdamResult minimize_adam(const DifferentiableFunction& function, Eigen::VectorXd start,
                         const AdamOptions& options,
                         const std::function<void(int iteration, double value)>& each = {});

}  // namespace vitruvian
