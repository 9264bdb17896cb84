#include "fit/adam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace vitruvian {
namespace {

// With one unknown and a constant gradient every bias-corrected step is exactly the step size.
TEST(Adam, StepsByTheStepSizeOnASlope) {
  AdamOptions options;
  options.iterations = 50;
  const AdamResult r = minimize_adam(
      [](const Eigen::VectorXd& x, Eigen::VectorXd& g) {
        g = Eigen::VectorXd::Constant(1, -3.0);
        return -3.0 * x[0];
      },
      Eigen::VectorXd::Constant(1, 2.0), options);
  EXPECT_NEAR(r.x[0], 2 + 50 * 0.005, 1e-7);
  EXPECT_EQ(r.iterations, 50);
  EXPECT_NEAR(r.value, -3 * r.x[0], 1e-12);
}

// The first three steps by hand (algorithm 1 of Kingma and Ba) on f = x^2 from 1.
TEST(Adam, FollowsTheAlgorithm) {
  double x = 1, m = 0, v = 0;
  AdamOptions options;
  options.iterations = 3;
  options.step = 0.1;
  for (int t = 1; t <= 3; ++t) {
    const double g = 2 * x;
    m = 0.9 * m + 0.1 * g;
    v = 0.999 * v + 0.001 * g * g;
    x -= 0.1 * (m / (1 - std::pow(0.9, t))) / (std::sqrt(v / (1 - std::pow(0.999, t))) + 1e-8);
  }
  std::vector<double> values;
  const AdamResult r = minimize_adam(
      [](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
        gradient = 2 * at;
        return at.squaredNorm();
      },
      Eigen::VectorXd::Ones(1), options,
      [&](int t, double value) {
        EXPECT_EQ(t, static_cast<int>(values.size()) + 1);
        values.push_back(value);
      });
  EXPECT_NEAR(r.x[0], x, 1e-14);
  ASSERT_EQ(values.size(), 3u);
  EXPECT_EQ(values[0], 1);
}

TEST(Adam, FindsAKnownOptimum) {
  Eigen::VectorXd optimum(4), scale(4);
  optimum << 1, -2, 0.5, 3;
  scale << 1, 10, 0.1, 100;
  AdamOptions options;
  options.iterations = 6000;
  const AdamResult r = minimize_adam(
      [&](const Eigen::VectorXd& x, Eigen::VectorXd& g) {
        g = scale.cwiseProduct(x - optimum);
        return 0.5 * (x - optimum).dot(g);
      },
      Eigen::VectorXd::Zero(4), options);
  EXPECT_LT((r.x - optimum).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Adam, RefusesWhatIsNotFinite) {
  const auto bad = [](const Eigen::VectorXd& x, Eigen::VectorXd& g) {
    g = x;
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_THROW(minimize_adam(bad, Eigen::VectorXd::Ones(2), {}), Error);
}

}  // namespace
}  // namespace vitruvian
