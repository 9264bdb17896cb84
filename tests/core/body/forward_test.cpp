#include "body/forward.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "core/body/random_model.h"

namespace vitruvian {
namespace {

TEST(Forward, RestStateGivesTheTemplate) {
  const BodyModel model = testing::random_model(1, 24, 40, 6, 4);
  const VertexMatrix<float> posed = posed_vertices<float>(model, BodyState::rest(model));
  EXPECT_LT((posed - model.v_template).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(Forward, TranslationMovesEverythingAlike) {
  const BodyModel model = testing::random_model(2, 10, 30, 4, 3);
  BodyState state = testing::random_state(model, 3);
  const VertexMatrix<double> before = posed_vertices<double>(model, state);
  const Vec3d shift(0.3, -2, 5);
  state.translation += shift;
  const VertexMatrix<double> after = posed_vertices<double>(model, state);
  EXPECT_LT(((after - before).colwise() - shift).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(Forward, RootRotationTurnsTheBodyAboutTheRestPelvis) {
  const BodyModel model = testing::random_model(4, 12, 30, 4, 3);
  BodyState state = testing::random_state(model, 5);
  const VertexMatrix<double> before = posed_vertices<double>(model, state);
  const Vec3d pivot = pose_skeleton(model, state).joints.col(0);
  const Mat3d turn = Eigen::AngleAxisd(1.1, Vec3d(1, 2, 3).normalized()).toRotationMatrix();
  state.rotation[0] = turn * state.rotation[0];
  const VertexMatrix<double> after = posed_vertices<double>(model, state);
  const VertexMatrix<double> expected = (turn * (before.colwise() - pivot)).colwise() + pivot;
  // Skinning weights are floats and sum to 1 only within 1e-7. Correctives do not depend on the root, so the
  // whole body turns rigidly.
  EXPECT_LT((after - expected).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(Forward, FloatAgreesWithDouble) {
  const BodyModel model = testing::random_model(6, 24, 50, 8, 4);
  const BodyState state = testing::random_state(model, 7);
  const VertexMatrix<double> exact = posed_vertices<double>(model, state);
  EXPECT_LT((posed_vertices<float>(model, state).cast<double>() - exact).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Forward, JointsFollowTheRegressorInRestPose) {
  const BodyModel model = testing::random_model(8, 24, 50, 8, 4);
  BodyState state = BodyState::rest(model);
  for (Index k = 0; k < state.betas.size(); ++k) state.betas[k] = 0.1 * static_cast<double>(k) - 0.3;
  VertexMatrix<double> shaped;
  shape_vertices(model, state.betas, shaped);
  Points3d expected = Points3d::Zero(3, model.joint_count());
  for (const auto& entry : model.regressor)
    expected.col(entry.joint) += entry.weight * shaped.col(entry.vertex);
  EXPECT_LT((pose_skeleton(model, state).joints - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Forward, OffsetsMoveTheRestVerticesAndNoJoint) {
  const BodyModel model = testing::random_model(10, 24, 60, 8, 4);
  const BodyState rest = BodyState::rest(model);
  Points3f offsets = Points3f::Zero(3, model.vertex_count());
  offsets.col(7) = Vec3f(0.01f, -0.02f, 0.03f);
  const Points3d moved = posed_vertices<double>(model, rest, offsets) - posed_vertices<double>(model, rest);
  EXPECT_LT((moved - offsets.cast<double>()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_EQ(posed_vertices<double>(model, rest, Points3f::Zero(3, model.vertex_count())),
            posed_vertices<double>(model, rest));
}

TEST(Forward, OffsetsFromDisplacementsUndoTheSkinning) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const BodyModel model = testing::random_model(seed, 24, 60, 8, 4);
    // Where rotations differ by less than 60 degrees no direction is lost.
    const BodyState state = testing::random_state(model, seed, 0.08);
    Random random(seed);
    Points3d displacement(3, model.vertex_count());
    for (Index i = 0; i < displacement.size(); ++i) displacement.data()[i] = 0.02 * random.normal();
    const Points3f offsets = offsets_from_displacements(model, pose_skeleton(model, state), displacement);
    const Points3d moved =
        posed_vertices<double>(model, state, offsets) - posed_vertices<double>(model, state);
    EXPECT_LT((moved - displacement).cwiseAbs().maxCoeff(), 1e-8);
  }
}

// Two joints that share a vertex in equal parts, turned against each other by a half turn: skinning maps the
// plane of the turn to a point, and no offset can move the vertex within it.
TEST(Forward, OffsetsStayBoundedWhereSkinningIsFlat) {
  BodyModel model = testing::random_model(11, 2, 12, 2, 2);
  model.parent = {-1, 0};
  for (int v = 0; v < 12; ++v) {
    model.skin_joint.col(v) << 0, 1;
    model.skin_weight.col(v) << 0.5f, 0.5f;
  }
  BodyState state = BodyState::rest(model);
  state.rotation[1] = Eigen::AngleAxisd(std::numbers::pi, Vec3d::UnitX()).toRotationMatrix();
  const Points3d displacement = Points3d::Constant(3, 12, 0.01);
  const Points3f offsets = offsets_from_displacements(model, pose_skeleton(model, state), displacement);
  EXPECT_LT((offsets.colwise() - Vec3f(0.01f, 0, 0)).cwiseAbs().maxCoeff(), 1e-7f);
}

TEST(BodyState, AxisAngleRoundTripOverNastyAngles) {
  Random random(9);
  for (const double angle : {0.0, 1e-9, 1e-5, 0.01, 1.0, 3.0, std::numbers::pi - 1e-6, std::numbers::pi}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3d axis = Vec3d(random.normal(), random.normal(), random.normal()).normalized();
      const Mat3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      Points3d pose(3, 1);
      pose.col(0) = angle * axis;
      const BodyState state = BodyState::from_axis_angle(pose, Eigen::VectorXd(), Vec3d::Zero());
      EXPECT_LT((state.rotation[0] - expected).cwiseAbs().maxCoeff(), 1e-12);
      const BodyState again =
          BodyState::from_axis_angle(state.axis_angle(), Eigen::VectorXd(), Vec3d::Zero());
      EXPECT_LT((again.rotation[0] - expected).cwiseAbs().maxCoeff(), 1e-9) << "angle " << angle;
    }
  }
}

}  // namespace
}  // namespace vitruvian
