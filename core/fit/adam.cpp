#include "fit/adam.h"

#include <cmath>

#include "base/error.h"

namespace vitruvian {

AdamResult minimize_adam(const DifferentiableFunction& function, Eigen::VectorXd start,
                         const AdamOptions& options, const std::function<void(int, double)>& each) {
  AdamResult result{std::move(start), 0, 0};
  Eigen::VectorXd gradient(result.x.size());
  Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(result.x.size()), square = mean;
  const auto evaluate = [&] {
    result.value = function(result.x, gradient);
    if (!std::isfinite(result.value) || !gradient.allFinite())
      throw Error(ErrorCode::internal, "Adam: the objective is not finite");
  };
  for (int t = 1; t <= options.iterations; ++t) {
    evaluate();
    mean = options.first_decay * mean + (1 - options.first_decay) * gradient.array();
    square = options.second_decay * square + (1 - options.second_decay) * gradient.array().square();
    const double mean_correction = 1 - std::pow(options.first_decay, t),
                 square_correction = 1 - std::pow(options.second_decay, t);
    result.x.array() -=
        options.step * (mean / mean_correction) / ((square / square_correction).sqrt() + options.epsilon);
    result.iterations = t;
    if (each) each(t, result.value);
  }
  evaluate();
  return result;
}

}  // namespace vitruvian
