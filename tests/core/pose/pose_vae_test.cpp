#include "pose/pose_vae.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/numeric_jacobian.h"
#include "core/pose/pose_fixtures.h"
#include "pose/rotation.h"

namespace vitruvian {
namespace {

using testing::expect_jacobian;
using testing::random_vae;
using testing::shipped_prior;
using testing::test_side_poses;

Eigen::VectorXd random_code(std::uint32_t seed, int size) {
  Random random(seed);
  Eigen::VectorXd z(size);
  for (int k = 0; k < size; ++k) z[k] = random.normal();
  return z;
}

TEST(PoseVae, JacobianMatchesDifferences) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const PoseVae small = random_vae(seed, 5, 9);
    for (const PoseVae* vae : {&small, &shipped_prior().vae}) {
      const Eigen::VectorXd z = random_code(seed + 100, vae->latent_count());
      const DecodedPose decoded(*vae, z);
      const Eigen::VectorXd pose = decoded.axis_angle();
      const auto moved = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
        Eigen::VectorXd other = decode(*vae, z + d);
        // A random network decodes rotations near half turns, where the vector may come out on the other
        // side.
        for (int j = 0; j < PoseVae::kJoints; ++j) {
          auto v = other.segment<3>(3 * j);
          if ((v - pose.segment<3>(3 * j)).norm() > 3) v *= 1 - 2 * 3.14159265358979324 / v.norm();
        }
        return other;
      };
      expect_jacobian(decoded.axis_angle_jacobian(), vae->latent_count(), moved, 1e-6, 1e-5);
    }
  }
}

TEST(PoseVae, PullBackMatchesDifferences) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const PoseVae vae = random_vae(seed, 6, 11);
    const Eigen::VectorXd z = random_code(seed + 50, 6);
    // f = sum over joints of a . R b, whose derivative by a small turn of R is (R b) x a.
    Random random(seed);
    std::vector<Vec3d> a, b;
    for (int j = 0; j < PoseVae::kJoints; ++j) {
      a.emplace_back(random.normal(), random.normal(), random.normal());
      b.emplace_back(random.normal(), random.normal(), random.normal());
    }
    const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      const DecodedPose decoded(vae, z + d);
      double sum = 0;
      for (int j = 0; j < PoseVae::kJoints; ++j) sum += a[j].dot(decoded.rotations()[j] * b[j]);
      return Eigen::VectorXd::Constant(1, sum);
    };
    const DecodedPose decoded(vae, z);
    Eigen::VectorXd by_turn(3 * PoseVae::kJoints);
    for (int j = 0; j < PoseVae::kJoints; ++j) {
      by_turn.segment<3>(3 * j) = Vec3d(decoded.rotations()[j] * b[j]).cross(a[j]);
    }
    expect_jacobian(decoded.pull_back(by_turn).transpose(), 6, f, 1e-6, 1e-6);
  }
}

TEST(PoseVae, DecodesProperRotationsFarOutToo) {
  const PoseVae& vae = shipped_prior().vae;
  for (const double scale : {0.0, 1.0, 10.0, 1000.0}) {
    const DecodedPose decoded(vae, scale * random_code(3, vae.latent_count()));
    for (const Mat3d& r : decoded.rotations()) {
      EXPECT_LT((r * r.transpose() - Mat3d::Identity()).norm(), 1e-9);
      EXPECT_NEAR(r.determinant(), 1, 1e-9);
    }
  }
}

TEST(PoseVae, StaysFiniteWhenTheNetworkPutsOutNothing) {
  PoseVae vae = random_vae(1, 4, 6);
  vae.decoder.back().weight.setZero();
  vae.decoder.back().bias.setZero();
  const DecodedPose decoded(vae, random_code(1, 4));
  EXPECT_TRUE(decoded.axis_angle().allFinite());
  EXPECT_TRUE(decoded.axis_angle_jacobian().allFinite());
}

TEST(PoseVae, ReconstructsPosesItHasNotSeen) {
  const PoseVae& vae = shipped_prior().vae;
  double sum = 0;
  const auto poses = test_side_poses();
  for (const Points3d& pose : poses) {
    const Eigen::Map<const Eigen::VectorXd> body(pose.data() + 3, 63);
    const DecodedPose decoded(vae, encode(vae, body));
    for (int j = 0; j < PoseVae::kJoints; ++j) {
      const Mat3d truth = rotation_from_vector<double>(body.segment<3>(3 * j));
      sum += vector_from_rotation<double>(decoded.rotations()[j] * truth.transpose()).norm();
    }
  }
  const double mean_degrees = sum / (21 * static_cast<double>(poses.size())) * 180 / 3.14159265358979324;
  RecordProperty("mean_degrees", std::to_string(mean_degrees));
  EXPECT_LT(mean_degrees, 8) << "these 60 are the most unusual poses of the test side";
}

TEST(PoseVae, TheZeroCodeIsAnOrdinaryPose) {
  const PosePrior& prior = shipped_prior();
  const Eigen::VectorXd pose = decode(prior.vae, Eigen::VectorXd::Zero(prior.vae.latent_count()));
  for (int k = 0; k < 63; ++k) {
    EXPECT_GT(pose[k], prior.limit_low[k]) << "number " << k;
    EXPECT_LT(pose[k], prior.limit_high[k]) << "number " << k;
  }
}

}  // namespace
}  // namespace vitruvian
