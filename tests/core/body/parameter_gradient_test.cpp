#include "body/parameter_gradient.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "body/jacobian.h"
#include "core/body/random_model.h"
#include "core/numeric_jacobian.h"

namespace vitruvian {
namespace {

class ParametricBodyTest : public ::testing::TestWithParam<std::uint32_t> {};

// f = sum c_v . x_v: its derivatives by the vertices are the constants c.
TEST_P(ParametricBodyTest, PullsLinearFunctionsBackLikeNumericDifferences) {
  const std::uint32_t seed = GetParam();
  SCOPED_TRACE("seed " + std::to_string(seed));
  const BodyModel model = testing::random_model(seed, 9, 400, 6, 4);
  const BodyState state = testing::random_state(model, seed + 1);
  ParametricBody body(model, 4);
  Eigen::VectorXd at = body.numbers_of(state);
  Random random(seed + 2);
  Points3f c(3, model.vertex_count());
  for (Index i = 0; i < c.size(); ++i) c.data()[i] = static_cast<float>(random.normal());

  body.pose(at);
  Eigen::VectorXd gradient;
  body.pull_back(c, gradient, Execution(2));
  // The forward model in double is the truth: float differences would drown in rounding.
  const auto value = [&](const Eigen::VectorXd& change) {
    const BodyState moved = body.state_of(at + change);
    Eigen::VectorXd f(1);
    f[0] = (posed_vertices<double>(model, moved).array() * c.cast<double>().array()).sum();
    return f;
  };
  testing::expect_jacobian(gradient.transpose(), body.size(), value, 1e-5, 1e-4);
}

TEST_P(ParametricBodyTest, AgreesWithTheJacobian) {
  const std::uint32_t seed = GetParam();
  SCOPED_TRACE("seed " + std::to_string(seed));
  const BodyModel model = testing::random_model(seed, 12, 60, 5, 3);
  BodyState state = testing::random_state(model, seed + 3, 1.0);
  ParametricBody body(model, 5);
  const Eigen::VectorXd at = body.numbers_of(state);
  const Points3f& vertices = body.pose(at);
  EXPECT_LT((vertices.cast<double>() - posed_vertices<double>(model, state)).cwiseAbs().maxCoeff(), 1e-5);
  Points3f c = Points3f::Zero(3, model.vertex_count());
  c(static_cast<Index>(seed % 3), 17) = 1;
  Eigen::VectorXd gradient;
  body.pull_back(c, gradient, Execution(1));

  const AncestorGroups groups(model);
  const Skeleton skeleton = pose_skeleton(model, state);
  VertexMatrix<double> rest;
  shape_vertices(model, state.betas, rest);
  add_correctives(model, state, rest);
  const BodyJacobian<double> jacobian(model, groups, state, skeleton, rest);
  Eigen::RowVectorXd row = jacobian.full_vertex(17).row(static_cast<Index>(seed % 3));
  const Points3d pose = state.axis_angle();
  for (int j = 0; j < model.joint_count(); ++j) {
    row.segment<3>(3 + 3 * j) =
        (row.segment<3>(3 + 3 * j) * axis_angle_chain(model, skeleton, pose.col(j), j)).eval();
  }
  EXPECT_LT((gradient.transpose() - row).cwiseAbs().maxCoeff(), 2e-5 * row.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Seeds, ParametricBodyTest, ::testing::Values(1u, 2u, 3u, 4u));

TEST(ParametricBody, NumbersAndStatesRoundTrip) {
  const BodyModel model = testing::random_model(5, 8, 30, 6, 2);
  const BodyState state = testing::random_state(model, 6);
  const ParametricBody body(model, 6);
  const BodyState back = body.state_of(body.numbers_of(state));
  for (int j = 0; j < 8; ++j) EXPECT_TRUE(back.rotation[j].isApprox(state.rotation[j], 1e-12));
  EXPECT_TRUE(back.betas.isApprox(state.betas));
  EXPECT_EQ(back.translation, state.translation);
  // Fewer components than the state has: the rest is dropped.
  EXPECT_EQ(ParametricBody(model, 2).numbers_of(state).tail(2), state.betas.head(2));
}

TEST(ParametricBody, ThreadsDoNotChangeMoreThanRounding) {
  const BodyModel model = testing::random_model(7, 24, 5000, 8, 4);
  ParametricBody body(model, 8);
  body.pose(body.numbers_of(testing::random_state(model, 8)));
  const Points3f c = Points3f::Random(3, 5000);
  Eigen::VectorXd one, two, again;
  body.pull_back(c, one, Execution(1));
  body.pull_back(c, two, Execution(2));
  body.pull_back(c, again, Execution(2));
  EXPECT_EQ(two, again) << "bit for bit with the same number of threads";
  EXPECT_TRUE(one.isApprox(two, 1e-9));
}

}  // namespace
}  // namespace vitruvian
