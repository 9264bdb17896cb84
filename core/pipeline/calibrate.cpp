#include "pipeline/calibrate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "body/forward.h"
#include "pipeline/landmark_stage.h"

namespace vitruvian {
namespace {

constexpr double kShapeSpread = 0.7;
constexpr int kViews = 8;
constexpr int kSmplJoints = 24;

/// A pose the prior thinks possible: decoded from the autoencoder, or drawn from the Gaussian, inside the
/// joint limits.
Points3d draw_pose(const BodyModel& body, const PosePrior& prior, Random& random) {
  const int joints = body.joint_count();
  Eigen::VectorXd numbers = prior.mean;
  if (!prior.vae.empty()) {
    Eigen::VectorXd code(prior.vae.latent_count());
    for (Index k = 0; k < code.size(); ++k) code[k] = random.normal();
    const Eigen::VectorXd decoded = decode(prior.vae, code);
    numbers.head(decoded.size()) = decoded;
  } else {
    const Eigen::MatrixXd factor = Eigen::MatrixXd(prior.precision.inverse()).llt().matrixL();
    Eigen::VectorXd noise(numbers.size());
    for (Index k = 0; k < noise.size(); ++k) noise[k] = 0.7 * random.normal();
    numbers += factor * noise;
  }
  numbers = numbers.cwiseMax(prior.limit_low).cwiseMin(prior.limit_high);
  Points3d pose = Points3d::Zero(3, joints);
  const Index known = std::min<Index>(joints - 1, numbers.size() / 3);
  pose.middleCols(1, known) = Eigen::Map<const Points3d>(numbers.data(), 3, known);
  pose(1, 0) = random.uniform(-std::numbers::pi, std::numbers::pi);
  return pose;
}

}  // namespace

Calibration calibrate_model(const BodyModel& body, const PosePrior& prior, int bodies, std::uint32_t seed,
                            const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                            const Execution& execution) {
  Random random(seed);
  std::vector<CalibrationBody> seen;
  for (int i = 0; i < bodies; ++i) {
    execution.check();
    Eigen::VectorXd betas = Eigen::VectorXd::Zero(body.beta_count());
    for (Index k = 0; k < body.shape_count(); ++k) betas[k] = kShapeSpread * random.normal();
    const BodyState state = BodyState::from_axis_angle(draw_pose(body, prior, random), betas, Vec3d::Zero());
    const Points3f vertices = posed_vertices<float>(body, state);
    const ViewSurface surface = prepare_surface(vertices, body.faces, Points3f(3, 0), execution);
    const Skeleton skeleton = pose_skeleton(body, state);
    LandmarkStage stage(surface, skeleton.global[0].col(1), kViews, 0, execution);
    while (const auto request = stage.next_request()) stage.accept(run_network(*request));
    CalibrationBody looked_at;
    looked_at.landmarks = stage.result().swap_aware;
    looked_at.joints.resize(3, kSmplJoints);
    for (int j = 0; j < kSmplJoints; ++j) {
      looked_at.joints.col(j) = skeleton.joints.col(body.joint_for_smpl(j));
      looked_at.rotations.push_back(skeleton.global[body.joint_for_smpl(j)]);
    }
    seen.push_back(std::move(looked_at));
    execution.progress("calibrate", static_cast<double>(i + 1) / bodies);
  }
  return calibrate_landmarks(seen);
}

std::vector<LandmarkOffset> landmarks_on(const BodyModel& body, std::vector<LandmarkOffset> offsets) {
  for (LandmarkOffset& offset : offsets) {
    offset.joint = body.joint_for_smpl(offset.joint);
    offset.frame_joint = body.joint_for_smpl(offset.frame_joint);
  }
  return offsets;
}

}  // namespace vitruvian
