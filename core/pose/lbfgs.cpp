#include "pose/lbfgs.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "base/error.h"

namespace vitruvian {
namespace {

struct Pair {
  Eigen::VectorXd step, change;  ///< of x and of the gradient
  double inverse_curvature;      ///< 1 / (step . change)
};

/// Two-loop recursion: minus the inverse Hessian's estimate times the gradient.
Eigen::VectorXd search_direction(const std::deque<Pair>& pairs, const Eigen::VectorXd& gradient) {
  Eigen::VectorXd direction = -gradient;
  std::vector<double> shares(pairs.size());
  for (std::size_t k = pairs.size(); k-- > 0;) {
    shares[k] = pairs[k].inverse_curvature * pairs[k].step.dot(direction);
    direction -= shares[k] * pairs[k].change;
  }
  if (!pairs.empty()) {
    const Pair& last = pairs.back();
    direction *= 1.0 / (last.inverse_curvature * last.change.squaredNorm());
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    direction += (shares[k] - pairs[k].inverse_curvature * pairs[k].change.dot(direction)) * pairs[k].step;
  }
  return direction;
}

/// The function along a ray.
struct Sample {
  double t = 0, value = 0, slope = 0;
  Eigen::VectorXd x, gradient;
  bool finite() const { return std::isfinite(value) && std::isfinite(slope) && gradient.allFinite(); }
};

class LineSearch {
 public:
  LineSearch(const DifferentiableFunction& function, const LbfgsOptions& options,
             const Eigen::VectorXd& direction, Sample origin)
      : function_(function), options_(options), direction_(direction), origin_(std::move(origin)) {}

  /// A point that meets the strong Wolfe conditions, or the best one that decreases enough; t = 0 when there
  /// is none.
  Sample run(double t) {
    Sample previous = origin_;
    while (evaluations < options_.line_search_evaluations) {
      Sample current = at(t);
      if (!current.finite()) return zoom(std::move(previous), std::move(current));
      if (!decreases(current) || (previous.t > 0 && current.value >= previous.value)) {
        return zoom(std::move(previous), std::move(current));
      }
      if (flat(current)) return current;
      if (current.slope >= 0) return zoom(std::move(current), std::move(previous));
      previous = std::move(current);
      t *= 2.5;
    }
    return previous;
  }

  int evaluations = 0;

 private:
  Sample at(double t) {
    ++evaluations;
    Sample sample;
    sample.t = t;
    sample.x = origin_.x + t * direction_;
    sample.gradient.resizeLike(sample.x);
    sample.value = function_(sample.x, sample.gradient);
    sample.slope = sample.gradient.dot(direction_);
    return sample;
  }
  bool decreases(const Sample& s) const {
    return s.value <= origin_.value + options_.sufficient_decrease * s.t * origin_.slope;
  }
  bool flat(const Sample& s) const { return std::abs(s.slope) <= -options_.curvature * origin_.slope; }

  /// Minimum of the cubic through both ends, kept off them by a tenth of the interval.
  static double between(const Sample& a, const Sample& b) {
    const double middle = 0.5 * (a.t + b.t);
    if (!a.finite() || !b.finite()) return middle;
    const double d1 = a.slope + b.slope - 3 * (a.value - b.value) / (a.t - b.t);
    const double square = d1 * d1 - a.slope * b.slope;
    if (!(square >= 0)) return middle;
    const double d2 = std::copysign(std::sqrt(square), b.t - a.t);
    const double t = b.t - (b.t - a.t) * (b.slope + d2 - d1) / (b.slope - a.slope + 2 * d2);
    const double low = std::min(a.t, b.t), high = std::max(a.t, b.t), margin = 0.1 * (high - low);
    return std::isfinite(t) ? std::clamp(t, low + margin, high - margin) : middle;
  }

  /// Shrinks an interval that holds an acceptable point; `low` is the end with the lower value.
  Sample zoom(Sample low, Sample high) {
    while (evaluations < options_.line_search_evaluations) {
      Sample current = at(between(low, high));
      if (!current.finite() || !decreases(current) || current.value >= low.value) {
        high = std::move(current);
      } else {
        if (flat(current)) return current;
        if (current.slope * (high.t - low.t) >= 0) high = std::move(low);
        low = std::move(current);
      }
    }
    return low;
  }

  const DifferentiableFunction& function_;
  const LbfgsOptions& options_;
  const Eigen::VectorXd& direction_;
  const Sample origin_;
};

}  // namespace

LbfgsResult minimize_lbfgs(const DifferentiableFunction& function, Eigen::VectorXd start,
                           const LbfgsOptions& options) {
  LbfgsResult result;
  result.x = std::move(start);
  result.gradient.resizeLike(result.x);
  result.value = function(result.x, result.gradient);
  result.evaluations = 1;
  if (!std::isfinite(result.value) || !result.gradient.allFinite()) {
    throw Error(ErrorCode::internal, "L-BFGS: the function is not finite at the starting point");
  }

  std::deque<Pair> pairs;
  while (true) {
    if (result.gradient.size() == 0 || result.gradient.cwiseAbs().maxCoeff() <= options.gradient_tolerance) {
      result.stop = LbfgsStop::gradient;
      return result;
    }
    if (result.iterations >= options.iterations) {
      result.stop = LbfgsStop::iterations;
      return result;
    }
    Eigen::VectorXd direction = search_direction(pairs, result.gradient);
    double slope = direction.dot(result.gradient);
    if (!(slope < 0) || !direction.allFinite()) {
      pairs.clear();
      direction = -result.gradient;
      slope = direction.dot(result.gradient);
    }
    const double first = pairs.empty() ? options.first_step / std::max(direction.norm(), 1e-300) : 1.0;
    LineSearch search(function, options, direction, {0, result.value, slope, result.x, result.gradient});
    Sample next = search.run(first);
    result.evaluations += search.evaluations;
    if (next.t <= 0) {
      if (pairs.empty()) {
        result.stop = LbfgsStop::line_search;
        return result;
      }
      // A stale estimate of the curvature can spoil the direction; steepest descent settles whether we are
      // done.
      pairs.clear();
      continue;
    }
    ++result.iterations;
    Pair pair{next.x - result.x, next.gradient - result.gradient, 0};
    const double curvature = pair.step.dot(pair.change);
    if (curvature > 1e-14 * pair.step.norm() * pair.change.norm()) {
      pair.inverse_curvature = 1 / curvature;
      pairs.push_back(std::move(pair));
      if (static_cast<int>(pairs.size()) > options.history) pairs.pop_front();
    }
    const double gain = result.value - next.value;
    result.x = std::move(next.x);
    result.value = next.value;
    result.gradient = std::move(next.gradient);
    if (options.each) options.each(result.iterations, result.value);
    if (gain <= options.decrease_tolerance * std::abs(result.value)) {
      result.stop = LbfgsStop::decrease;
      return result;
    }
  }
}

}  // namespace vitruvian
