#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>

namespace vitruvian::testing {

/// The one harness for derivatives: central differences of `value(update)` at update = 0 against `analytic`,
/// relative to the largest entry.
inline void expect_jacobian(const Eigen::MatrixXd& analytic, Eigen::Index unknowns,
                            const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& value, double step,
                            double tolerance) {
  ASSERT_EQ(analytic.cols(), unknowns);
  Eigen::MatrixXd numeric(analytic.rows(), unknowns);
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    Eigen::VectorXd update = Eigen::VectorXd::Zero(unknowns);
    update[k] = step;
    const Eigen::VectorXd above = value(update);
    update[k] = -step;
    numeric.col(k) = (above - value(update)) / (2 * step);
  }
  const double scale = std::max(1e-12, numeric.cwiseAbs().maxCoeff());
  Eigen::Index row, column;
  const double worst = (analytic - numeric).cwiseAbs().maxCoeff(&row, &column);
  EXPECT_LT(worst / scale, tolerance) << "at row " << row << ", unknown " << column << ": analytic "
                                      << analytic(row, column) << ", numeric " << numeric(row, column);
}

}  // namespace vitruvian::testing
