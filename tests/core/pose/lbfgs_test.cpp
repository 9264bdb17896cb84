#include "pose/lbfgs.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

/// Extended Rosenbrock function; minimum 0 at (1, ..., 1).
double rosenbrock(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
  gradient.setZero();
  double value = 0;
  for (Eigen::Index k = 0; k + 1 < x.size(); ++k) {
    const double a = x[k + 1] - x[k] * x[k], b = 1 - x[k];
    value += 100 * a * a + b * b;
    gradient[k] += -400 * x[k] * a - 2 * b;
    gradient[k + 1] += 200 * a;
  }
  return value;
}

TEST(Lbfgs, FindsTheMinimumOfRosenbrock) {
  for (const int n : {2, 5, 20}) {
    Eigen::VectorXd start(n);
    for (int k = 0; k < n; ++k) start[k] = k % 2 ? 1.0 : -1.2;
    LbfgsOptions options;
    options.iterations = 1000;
    options.decrease_tolerance = 0;
    const LbfgsResult result = minimize_lbfgs(rosenbrock, start, options);
    EXPECT_LT(result.gradient.cwiseAbs().maxCoeff(), 1e-6) << n;
    if (n == 2) {
      EXPECT_LT((result.x - Eigen::VectorXd::Ones(n)).norm(), 1e-6);
    }
    EXPECT_LT(result.evaluations, 60 + 25 * n);
  }
}

TEST(Lbfgs, SolvesIllConditionedQuadratics) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    constexpr int n = 40;
    Eigen::MatrixXd q(n, n);
    for (Eigen::Index i = 0; i < q.size(); ++i) q.data()[i] = random.normal();
    const Eigen::MatrixXd basis = Eigen::MatrixXd(q.householderQr().householderQ());
    Eigen::VectorXd eigenvalues(n), optimum(n);
    for (int k = 0; k < n; ++k) {
      eigenvalues[k] = std::pow(10.0, 4.0 * k / (n - 1));
      optimum[k] = random.normal();
    }
    const Eigen::MatrixXd hessian = basis * eigenvalues.asDiagonal() * basis.transpose();
    const auto quadratic = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
      gradient = hessian * (x - optimum);
      return 0.5 * gradient.dot(x - optimum) + 3;
    };
    LbfgsOptions options;
    options.iterations = 2000;
    options.decrease_tolerance = 0;
    options.gradient_tolerance = 1e-8;
    const LbfgsResult result = minimize_lbfgs(quadratic, Eigen::VectorXd::Zero(n), options);
    EXPECT_LT((result.x - optimum).norm(), 1e-5) << "seed " << seed;
    EXPECT_NEAR(result.value, 3, 1e-9);
  }
}

TEST(Lbfgs, BacksOutOfPlacesWhereTheFunctionIsNotFinite) {
  // Minimum at x = 2, not defined for x <= 0, infinite far out; the first step overshoots into both.
  const auto barrier = [](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    gradient[0] = 1 - 2 / x[0];
    if (x[0] > 50) return std::numeric_limits<double>::infinity();
    return x[0] > 0 ? x[0] - 2 * std::log(x[0]) : std::numeric_limits<double>::quiet_NaN();
  };
  for (const double first : {0.1, 10.0, 1e4}) {
    for (const double start : {0.01, 1.0, 30.0}) {
      LbfgsOptions options;
      options.first_step = first;
      options.line_search_evaluations = 60;
      const LbfgsResult result = minimize_lbfgs(barrier, Eigen::VectorXd::Constant(1, start), options);
      EXPECT_NEAR(result.x[0], 2, 1e-4) << "start " << start << ", first step " << first;
    }
  }
}

TEST(Lbfgs, AcceptedValuesNeverRise) {
  Eigen::VectorXd start(2);
  start << -1.2, 1;
  double previous = std::numeric_limits<double>::infinity();
  for (int iterations = 0; iterations < 40; ++iterations) {
    LbfgsOptions options;
    options.iterations = iterations;
    const LbfgsResult result = minimize_lbfgs(rosenbrock, start, options);
    EXPECT_LE(result.value, previous);
    EXPECT_LE(result.iterations, iterations);
    Eigen::VectorXd gradient(2);
    EXPECT_EQ(rosenbrock(result.x, gradient), result.value);
    previous = result.value;
  }
}

TEST(Lbfgs, SaysWhyItStopped) {
  EXPECT_EQ(minimize_lbfgs(rosenbrock, Eigen::VectorXd::Ones(3)).stop, LbfgsStop::gradient);
  LbfgsOptions options;
  options.iterations = 2;
  const LbfgsResult result = minimize_lbfgs(rosenbrock, Eigen::VectorXd::Zero(3), options);
  EXPECT_EQ(result.stop, LbfgsStop::iterations);
  EXPECT_EQ(result.iterations, 2);
  // A gradient that points uphill: no step can succeed.
  const auto wrong = [](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    gradient = -x;
    return 0.5 * x.squaredNorm();
  };
  const LbfgsResult stuck = minimize_lbfgs(wrong, Eigen::VectorXd::Ones(2));
  EXPECT_EQ(stuck.stop, LbfgsStop::line_search);
  EXPECT_EQ(stuck.value, 1);
}

TEST(Lbfgs, RefusesAStartThatIsNotFinite) {
  const auto nowhere = [](const Eigen::VectorXd&, Eigen::VectorXd& gradient) {
    gradient.setZero();
    return std::numeric_limits<double>::quiet_NaN();
  };
  try {
    minimize_lbfgs(nowhere, Eigen::VectorXd::Ones(2));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::internal);
  }
}

TEST(Lbfgs, LetsAnExceptionOfTheFunctionThrough) {
  int calls = 0;
  const auto cancelled = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    if (++calls == 5) throw Error(ErrorCode::cancelled, "cancelled");
    return rosenbrock(x, gradient);
  };
  EXPECT_THROW(minimize_lbfgs(cancelled, Eigen::VectorXd::Zero(3)), Error);
  EXPECT_EQ(calls, 5);
}

}  // namespace
}  // namespace vitruvian
