#include "pose/skeleton_prior.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/pose/pose_fixtures.h"
#include "core/smpl/smpl_fixtures.h"

namespace vitruvian {
namespace {

using testing::read_smpl_file;
using testing::shipped_prior;

TEST(SkeletonPrior, StaysAsItIsForTwentyFourJoints) {
  const PosePrior prior = prior_for_skeleton(shipped_prior(), read_smpl_file("own_smpl.npz"));
  EXPECT_EQ(prior.mean, shipped_prior().mean);
  EXPECT_EQ(prior.precision, shipped_prior().precision);
}

TEST(SkeletonPrior, FitsEveryOtherSkeleton) {
  for (const char* name : {"SMPLH_NEUTRAL.npz", "SMPLX_MALE.pkl"}) {
    const BodyModel body = read_smpl_file(name);
    const PosePrior prior = prior_for_skeleton(shipped_prior(), body);
    const Index size = 3 * (body.joint_count() - 1);
    ASSERT_EQ(prior.mean.size(), size) << name;
    ASSERT_EQ(prior.precision.rows(), size) << name;
    EXPECT_EQ(prior.precision.llt().info(), Eigen::Success) << name;
    EXPECT_TRUE((prior.limit_low.array() < prior.limit_high.array()).all()) << name;
    EXPECT_TRUE((prior.limit_low.array() < prior.mean.array()).tail(size - 63).all()) << name;
    // What is said of the body is what the whole prior says of it when the hands are not looked at.
    const Eigen::MatrixXd wanted = Eigen::MatrixXd(shipped_prior().precision.inverse()).topLeftCorner(63, 63);
    const Eigen::MatrixXd covariance = prior.precision.inverse();
    EXPECT_LT((covariance.topLeftCorner(63, 63) - wanted).cwiseAbs().maxCoeff(),
              1e-6 * wanted.cwiseAbs().maxCoeff());
    // A hand moves far along its first component and hardly across all of them.
    const int first =
        body.joint_for_smpl(22) - 4;  // numbers begin at joint 1; middle1 is the hand's fourth joint
    const Eigen::MatrixXd hand = covariance.block(3 * first, 3 * first, 45, 45);
    const HandPoses& known = body.hands[0];
    const double along = known.components.col(0).dot(hand * known.components.col(0));
    EXPECT_NEAR(std::sqrt(along), known.deviation[0], 0.01) << name;
    EXPECT_LT(std::sqrt(hand.trace() - known.deviation.squaredNorm()), 0.15) << name;
  }
}

}  // namespace
}  // namespace vitruvian
