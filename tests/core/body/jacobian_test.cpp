#include "body/jacobian.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/body/random_model.h"
#include "core/numeric_jacobian.h"

namespace vitruvian {
namespace {

struct Size {
  int joints, vertices, betas, weights;
  PoseFeature feature = PoseFeature::rotation;
};

class JacobianTest : public ::testing::TestWithParam<Size> {
 protected:
  BodyModel model = testing::random_model(11, GetParam().joints, GetParam().vertices, GetParam().betas,
                                          GetParam().weights, GetParam().feature);
  AncestorGroups groups{model};
  BodyState state = testing::random_state(model, 12);
  Skeleton skeleton = pose_skeleton(model, state);
  Index unknowns = 3 + 3 * model.joint_count() + model.beta_count();

  template <typename Scalar>
  VertexMatrix<Scalar> rest() const {
    VertexMatrix<Scalar> vertices;
    shape_vertices(model, state.betas, vertices);
    add_correctives(model, state, vertices);
    return vertices;
  }
  BodyState updated(const Eigen::VectorXd& update) const {
    BodyState changed = state;
    apply_update(model, skeleton, update, changed);
    return changed;
  }
};

TEST_P(JacobianTest, VertexDerivativesMatchNumericOnes) {
  const VertexMatrix<double> shaped = rest<double>();
  const BodyJacobian<double> jacobian(model, groups, state, skeleton, shaped);
  for (int v = 0; v < model.vertex_count(); ++v) {
    testing::expect_jacobian(
        jacobian.full_vertex(v), unknowns,
        [&](const Eigen::VectorXd& update) {
          return Eigen::VectorXd(posed_vertices<double>(model, updated(update)).col(v));
        },
        1e-5, 2e-7);
  }
}

TEST_P(JacobianTest, FloatDerivativesMatchDoubleOnes) {
  const VertexMatrix<double> shaped = rest<double>();
  const VertexMatrix<float> shaped_float = rest<float>();
  const BodyJacobian<double> exact(model, groups, state, skeleton, shaped);
  const BodyJacobian<float> fast(model, groups, state, skeleton, shaped_float);
  for (int v = 0; v < model.vertex_count(); ++v) {
    const Eigen::MatrixXd expected = exact.full_vertex(v);
    const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
    EXPECT_LT((fast.full_vertex(v).cast<double>() - expected).cwiseAbs().maxCoeff() / scale, 2e-5);
  }
}

TEST_P(JacobianTest, JointDerivativesMatchNumericOnes) {
  const VertexMatrix<double> shaped = rest<double>();
  const BodyJacobian<double> jacobian(model, groups, state, skeleton, shaped);
  for (int j = 0; j < model.joint_count(); ++j) {
    testing::expect_jacobian(
        jacobian.full_joint(j), unknowns,
        [&](const Eigen::VectorXd& update) {
          return Eigen::VectorXd(pose_skeleton(model, updated(update)).joints.col(j));
        },
        1e-5, 1e-7);
  }
}

TEST_P(JacobianTest, AxisAngleChainMatchesNumericDerivative) {
  const VertexMatrix<double> shaped = rest<double>();
  const BodyJacobian<double> jacobian(model, groups, state, skeleton, shaped);
  const Points3d pose = state.axis_angle();
  for (int j = 0; j < model.joint_count(); ++j) {
    const Mat3d chain = axis_angle_chain(model, skeleton, pose.col(j), j);
    for (int v = 0; v < model.vertex_count(); v += 3) {
      testing::expect_jacobian(
          jacobian.full_vertex(v).middleCols<3>(3 + 3 * j) * chain, 3,
          [&](const Eigen::VectorXd& change) {
            Points3d moved = pose;
            moved.col(j) += change;
            return Eigen::VectorXd(posed_vertices<double>(model, BodyState::from_axis_angle(
                                                                     moved, state.betas, state.translation))
                                       .col(v));
          },
          1e-5, 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, JacobianTest,
                         ::testing::Values(Size{1, 5, 1, 1}, Size{5, 9, 3, 2}, Size{24, 12, 10, 4},
                                           Size{55, 8, 20, 6},
                                           Size{24, 12, 10, 20, PoseFeature::quaternion}));

TEST(PoseFeature, DerivativesMatchNumericOnes) {
  Random random(31);
  for (const PoseFeature kind : {PoseFeature::rotation, PoseFeature::quaternion}) {
    for (const double angle : {0.0, 1e-5, 0.3, 1.5, 3.0}) {
      const Vec3d axis = Vec3d(random.normal(), random.normal(), random.normal()).normalized();
      const Mat3d rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      testing::expect_jacobian(
          pose_feature_by_turn(kind, rotation), 3,
          [&](const Eigen::VectorXd& w) {
            const double turn = w.norm();
            const Mat3d moved = turn > 0 ? Mat3d(Eigen::AngleAxisd(turn, w / turn) * rotation) : rotation;
            return Eigen::VectorXd(pose_feature(kind, moved));
          },
          1e-6, 1e-8);
    }
  }
}

TEST(AncestorGroups, KeepTheStrongestCorrectives) {
  const BodyModel model = testing::random_model(21, 24, 30, 3, 4);
  const AncestorGroups all(model), few(model, 3);
  for (int v = 0; v < model.vertex_count(); ++v) {
    const int blocks = model.corrective_begin[v + 1] - model.corrective_begin[v];
    EXPECT_EQ(all.block_begin[v + 1] - all.block_begin[v], blocks);
    ASSERT_EQ(few.block_begin[v + 1] - few.block_begin[v], std::min(blocks, 3));
    float weakest_kept = 1e9f, strongest_left = 0;
    for (int b = model.corrective_begin[v]; b < model.corrective_begin[v + 1]; ++b) {
      const auto begin = few.block.begin() + few.block_begin[v],
                 end = few.block.begin() + few.block_begin[v + 1];
      const float size = model.corrective[b].norm();
      if (std::find(begin, end, b) != end) {
        weakest_kept = std::min(weakest_kept, size);
      } else {
        strongest_left = std::max(strongest_left, size);
      }
    }
    EXPECT_GE(weakest_kept, strongest_left);
  }
}

}  // namespace
}  // namespace vitruvian
