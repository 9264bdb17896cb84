#include "fit/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <functional>
#include <limits>

#include "core/body/random_model.h"
#include "core/numeric_jacobian.h"

namespace vitruvian {
namespace {

using Residuals = std::function<Eigen::VectorXd(const BodyState&)>;

PosePrior random_prior(std::uint32_t seed) {
  Random random(seed);
  PosePrior prior;
  prior.mean.resize(PosePrior::kSize);
  Eigen::MatrixXd root(PosePrior::kSize, PosePrior::kSize);
  for (Index i = 0; i < prior.mean.size(); ++i) prior.mean[i] = 0.3 * random.normal();
  for (Index i = 0; i < root.size(); ++i) root.data()[i] = random.normal();
  prior.precision = root * root.transpose() / 10 + Eigen::MatrixXd::Identity(root.rows(), root.cols());
  prior.limit_low = prior.mean.array() - 0.4;
  prior.limit_high = prior.mean.array() + 0.4;
  return prior;
}

/// A random model, its pose and the system at that pose. The betas fitted may be fewer than the model's.
class NormalEquationsTest : public ::testing::TestWithParam<int> {
 protected:
  static constexpr int kVertices = 60, kModelBetas = 6;

  BodyModel body = make_body();
  PosePrior prior = random_prior(21);
  FitModel model{body, prior, Gender::female, GetParam()};
  BodyState state = make_state();
  PosedModel posed = make_posed();
  BodyJacobian<float> jacobian{body, model.groups, state, posed.skeleton, posed.rest};
  NormalEquations equations{model};

  static BodyModel make_body() {
    BodyModel body = testing::random_model(31, 24, kVertices, kModelBetas, 4);
    Random random(5);
    for (ShapePrior& shape : body.priors) {
      Eigen::MatrixXd root(kModelBetas, kModelBetas);
      for (Index i = 0; i < root.size(); ++i) root.data()[i] = random.normal();
      shape.precision = root * root.transpose() + Eigen::MatrixXd::Identity(kModelBetas, kModelBetas);
      for (Index k = 0; k < kModelBetas; ++k) shape.mean[k] = random.normal();
    }
    return body;
  }
  BodyState make_state() const {
    BodyState random = testing::random_state(body, 32, 0.4);
    random.betas.conservativeResize(model.betas);
    return random;
  }
  PosedModel make_posed() const {
    PosedModel result;
    result.update(model, state);
    return result;
  }

  std::vector<Correspondence> correspondences(int count, std::uint32_t seed) const {
    Random random(seed);
    std::vector<Correspondence> result;
    for (int i = 0; i < count; ++i) {
      const int v = static_cast<int>(random.below(kVertices));
      const Vec3f normal =
          Vec3d(random.normal(), random.normal(), random.normal()).normalized().cast<float>();
      const Vec3f error =
          Vec3d(0.1 * random.normal(), 0.1 * random.normal(), 0.1 * random.normal()).cast<float>();
      // Some are rejected pairs, some have no isotropic part.
      const float weight = random.below(6) == 0 ? 0 : static_cast<float>(random.uniform(0.1, 1));
      result.push_back({v, weight, random.below(3) == 0 ? 0 : 0.3f, normal, error});
    }
    return result;
  }

  /// Compares the system with J^T J and J^T r of the residuals whose squares the energy sums.
  void expect_system(const Residuals& residuals, double tolerance) const {
    const Skeleton& skeleton = posed.skeleton;
    const auto value = [&](const Eigen::VectorXd& update) {
      BodyState changed = state;
      apply_update(body, skeleton, update, changed);
      return residuals(changed);
    };
    const Index unknowns = model.unknowns();
    ASSERT_EQ(equations.gradient().size(), unknowns);
    // The system is that of half the energy.
    testing::expect_jacobian(
        equations.gradient().transpose(), unknowns,
        [&](const Eigen::VectorXd& update) {
          return Eigen::VectorXd::Constant(1, 0.5 * value(update).squaredNorm());
        },
        1e-5, tolerance);
    const Eigen::VectorXd at_zero = value(Eigen::VectorXd::Zero(unknowns));
    Eigen::MatrixXd numeric(at_zero.size(), unknowns);
    for (Index k = 0; k < unknowns; ++k) {
      Eigen::VectorXd update = Eigen::VectorXd::Zero(unknowns);
      update[k] = 1e-5;
      numeric.col(k) = value(update);
      update[k] = -1e-5;
      numeric.col(k) = (numeric.col(k) - value(update)) / 2e-5;
    }
    const Eigen::MatrixXd expected = numeric.transpose() * numeric;
    const Eigen::MatrixXd actual = equations.hessian().selfadjointView<Eigen::Lower>();
    EXPECT_LT((actual - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), tolerance);
  }
};

TEST_P(NormalEquationsTest, SurfaceTermIsThatOfItsEnergy) {
  const double scale = 3.5;
  const std::vector<Correspondence> pairs = correspondences(700, 41);
  const VertexMatrix<double> now = posed_vertices<double>(body, state);
  equations.add(jacobian, pairs, scale, Execution(1));
  expect_system(
      [&](const BodyState& changed) {
        const VertexMatrix<double> moved = posed_vertices<double>(body, changed);
        Eigen::VectorXd rows(4 * static_cast<Index>(pairs.size()));
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          const Correspondence& c = pairs[i];
          const Vec3d error = c.error.cast<double>() + moved.col(c.vertex) - now.col(c.vertex);
          const double root = std::sqrt(scale * c.weight);
          rows[4 * static_cast<Index>(i)] = root * c.normal.cast<double>().dot(error);
          rows.segment<3>(4 * static_cast<Index>(i) + 1) = root * std::sqrt(c.isotropy) * error;
        }
        return rows;
      },
      1e-4);
}

TEST_P(NormalEquationsTest, LandmarkTermIsThatOfItsEnergy) {
  Random random(51);
  const double scale = 2.5;
  std::vector<LandmarkTarget> landmarks;
  for (int i = 0; i < 12; ++i) {
    const int joint = static_cast<int>(random.below(24)), frame = static_cast<int>(random.below(24));
    const Vec3d offset(random.normal(), random.normal(), random.normal()),
        target(random.normal(), random.normal(), random.normal());
    landmarks.push_back({i, joint, i % 2 ? joint : frame, 0.1 * offset, target, random.uniform(0.1, 1.2)});
    equations.add(jacobian, posed, landmarks.back(), scale);
  }
  expect_system(
      [&](const BodyState& changed) {
        const Skeleton skeleton = pose_skeleton(body, changed);
        Eigen::VectorXd rows(3 * static_cast<Index>(landmarks.size()));
        for (std::size_t i = 0; i < landmarks.size(); ++i) {
          rows.segment<3>(3 * static_cast<Index>(i)) =
              std::sqrt(scale * landmarks[i].weight) *
              (landmark_position(skeleton, landmarks[i]) - landmarks[i].target);
        }
        return rows;
      },
      1e-6);
}

TEST_P(NormalEquationsTest, UnusedLandmarksAddNothing) {
  LandmarkTarget unused{11, 16, 16, Vec3d::Zero(), Vec3d::Constant(std::numeric_limits<double>::quiet_NaN()),
                        0};
  equations.add(jacobian, posed, unused, 1);
  EXPECT_EQ(equations.hessian().cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(equations.gradient().cwiseAbs().maxCoeff(), 0);
}

TEST_P(NormalEquationsTest, GaussianPosePriorIsThatOfItsEnergy) {
  const double weight = 0.7;
  equations.add_pose_prior(state, posed, weight, 0);
  const Eigen::MatrixXd root = prior.precision.llt().matrixU();
  expect_system(
      [&](const BodyState& changed) {
        const Points3d pose = changed.axis_angle();
        const Eigen::Map<const Eigen::VectorXd> theta(pose.data() + 3, PosePrior::kSize);
        return Eigen::VectorXd(std::sqrt(weight / PosePrior::kSize) * (root * (theta - prior.mean)));
      },
      1e-6);
}

TEST_P(NormalEquationsTest, JointLimitsAreThoseOfTheirEnergy) {
  const double weight = 0.7;
  equations.add_pose_prior(state, posed, 0, weight);
  int beyond = 0;
  expect_system(
      [&](const BodyState& changed) {
        const Points3d pose = changed.axis_angle();
        Eigen::VectorXd rows(PosePrior::kSize);
        beyond = 0;
        for (Index i = 0; i < PosePrior::kSize; ++i) {
          const double theta = pose.data()[3 + i];
          const double excess = std::max({0.0, prior.limit_low[i] - theta, theta - prior.limit_high[i]});
          rows[i] = std::sqrt(weight / PosePrior::kSize) * excess / 0.1;
          beyond += excess > 0;
        }
        return rows;
      },
      1e-6);
  EXPECT_GT(beyond, 5);
  EXPECT_LT(beyond, PosePrior::kSize - 5);
}

TEST_P(NormalEquationsTest, ShapePriorIsThatOfItsEnergy) {
  const double weight = 0.4;
  equations.add_shape_prior(state, weight);
  // Fewer betas than the model's: the marginal of the prior, whose covariance is the cut one.
  const ShapePrior& whole = body.prior(Gender::female);
  const Eigen::MatrixXd covariance = whole.precision.inverse().topLeftCorner(model.betas, model.betas);
  const Eigen::MatrixXd root = covariance.inverse().llt().matrixU();
  expect_system(
      [&](const BodyState& changed) {
        return Eigen::VectorXd(std::sqrt(weight / model.betas) *
                               (root * (changed.betas - whole.mean.head(model.betas))));
      },
      1e-6);
}

TEST_P(NormalEquationsTest, TermsAddUpAndClearForgetsThem) {
  const std::vector<Correspondence> pairs = correspondences(200, 61);
  equations.add(jacobian, pairs, 2, Execution(1));
  const Eigen::MatrixXd once = equations.hessian();
  const Eigen::VectorXd gradient = equations.gradient();
  equations.add(jacobian, pairs, 2, Execution(1));
  EXPECT_LT((equations.hessian() - 2 * once).cwiseAbs().maxCoeff(), 1e-12 * once.cwiseAbs().maxCoeff());
  equations.clear();
  equations.add(jacobian, pairs, 4, Execution(1));
  EXPECT_LT((equations.gradient() - 2 * gradient).cwiseAbs().maxCoeff(),
            1e-12 * gradient.cwiseAbs().maxCoeff());
}

TEST_P(NormalEquationsTest, ThreadsChangeNothingBeyondRounding) {
  const std::vector<Correspondence> pairs = correspondences(20000, 71);
  const auto step_with = [&](int threads) {
    equations.clear();
    equations.add(jacobian, pairs, 1, Execution(threads));
    equations.add_pose_prior(state, posed, 0.1, 0.1);
    equations.add_shape_prior(state, 0.1);
    BodyState result = state;
    equations.step(posed, 1e-3, 0.4, result);
    return result;
  };
  const BodyState one = step_with(1), two = step_with(2), again = step_with(2);
  for (int j = 0; j < body.joint_count(); ++j) {
    EXPECT_EQ(two.rotation[j], again.rotation[j]);
    EXPECT_LT((one.rotation[j] - two.rotation[j]).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_EQ(two.betas, again.betas);
  EXPECT_EQ(two.translation, again.translation);
  EXPECT_LT((one.betas - two.betas).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((one.translation - two.translation).norm(), 1e-9);
  EXPECT_GT((one.translation - state.translation).norm(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Betas, NormalEquationsTest, ::testing::Values(0, 4));

TEST_P(NormalEquationsTest, StepsKeepWithinTheirBounds) {
  std::vector<Correspondence> pairs = correspondences(500, 81);
  for (Correspondence& c : pairs) c.error *= 1000;
  equations.add(jacobian, pairs, 1, Execution(1));
  BodyState moved = state;
  equations.step(posed, 1e-3, 0.25, moved);
  EXPECT_LE(moved.betas.cwiseAbs().maxCoeff(), 5);
  double largest = 0;
  for (int j = 0; j < body.joint_count(); ++j) {
    const Mat3d turn = moved.rotation[j] * state.rotation[j].transpose();
    largest = std::max(largest, Eigen::AngleAxisd(turn).angle());
    EXPECT_LT((moved.rotation[j] * moved.rotation[j].transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff(),
              1e-12);
  }
  EXPECT_LT(largest, 0.25 + 1e-9);
  EXPECT_GT(largest, 0.2);
}

TEST_P(NormalEquationsTest, AHeldJointHardlyMoves) {
  const std::vector<Correspondence> pairs = correspondences(500, 91);
  const auto turn_of = [&](double hold) {
    equations.clear();
    equations.add(jacobian, pairs, 1, Execution(1));
    equations.hold_joint(7, hold);
    BodyState moved = state;
    equations.step(posed, 1e-3, 1, moved);
    return Eigen::AngleAxisd(Mat3d(moved.rotation[7] * state.rotation[7].transpose())).angle();
  };
  EXPECT_GT(turn_of(0), 1e-3);
  EXPECT_LT(turn_of(1e9), 1e-6);
}

// A system that cannot be solved must leave the body where it is.
TEST_P(NormalEquationsTest, NotANumberStopsAtTheStep) {
  std::vector<Correspondence> pairs = correspondences(50, 101);
  for (Correspondence& c : pairs) c.error[1] = std::numeric_limits<float>::quiet_NaN();
  equations.add(jacobian, pairs, 1, Execution(1));
  BodyState moved = state;
  equations.step(posed, 1e-3, 1, moved);
  EXPECT_EQ(moved.betas, state.betas);
  EXPECT_EQ(moved.translation, state.translation);
}

TEST(NormalEquations, APriorForAnotherSkeletonIsLeftOut) {
  const BodyModel body = testing::random_model(3, 10, 20, 4, 3);
  const PosePrior prior = random_prior(4);
  const FitModel model(body, prior, Gender::neutral, 0);
  const BodyState state = testing::random_state(body, 5);
  PosedModel posed;
  posed.update(model, state);
  NormalEquations equations(model);
  equations.add_pose_prior(state, posed, 1, 1);
  EXPECT_EQ(equations.hessian().cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace vitruvian
