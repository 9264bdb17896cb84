#include "pipeline/calibrate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
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

/// A posed body and the pictures of it.
struct LandmarkCalibrator::Look {
  Look(const BodyModel& body, const BodyState& state, const Execution& execution)
      : surface(prepare_surface(posed_vertices<float>(body, state), body.faces, Points3f(3, 0), execution)),
        skeleton(pose_skeleton(body, state)),
        stage(surface, skeleton.global[0].col(1), kViews, 0, execution) {}

  ViewSurface surface;
  Skeleton skeleton;
  LandmarkStage stage;
};

LandmarkCalibrator::LandmarkCalibrator(const BodyModel& body, const PosePrior& prior, int bodies,
                                       std::uint32_t seed, const Execution& execution)
    : body_(body),
      prior_(prior),
      bodies_(static_cast<std::size_t>(bodies)),
      execution_(execution),
      random_(seed) {}

LandmarkCalibrator::~LandmarkCalibrator() = default;

std::optional<NetworkRequest> LandmarkCalibrator::next_request() {
  for (;;) {
    execution_.check();
    if (look_) {
      if (auto request = look_->stage.next_request()) return request;
      CalibrationBody looked_at;
      looked_at.landmarks = look_->stage.result().swap_aware;
      looked_at.joints.resize(3, kSmplJoints);
      for (int j = 0; j < kSmplJoints; ++j) {
        looked_at.joints.col(j) = look_->skeleton.joints.col(body_.joint_for_smpl(j));
        looked_at.rotations.push_back(look_->skeleton.global[body_.joint_for_smpl(j)]);
      }
      seen_.push_back(std::move(looked_at));
      look_.reset();
      execution_.progress("calibrate", static_cast<double>(seen_.size()) / static_cast<double>(bodies_));
    }
    if (seen_.size() >= bodies_) return std::nullopt;
    Eigen::VectorXd betas = Eigen::VectorXd::Zero(body_.beta_count());
    for (Index k = 0; k < body_.shape_count(); ++k) betas[k] = kShapeSpread * random_.normal();
    const BodyState state =
        BodyState::from_axis_angle(draw_pose(body_, prior_, random_), betas, Vec3d::Zero());
    look_ = std::make_unique<Look>(body_, state, execution_);
  }
}

void LandmarkCalibrator::accept(const NetworkReply& reply) {
  if (!look_) throw Error(ErrorCode::internal, "a reply to a request that was not made");
  look_->stage.accept(reply);
}

Calibration calibrate_model(const BodyModel& body, const PosePrior& prior, int bodies, std::uint32_t seed,
                            const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                            const Execution& execution) {
  LandmarkCalibrator calibrator(body, prior, bodies, seed, execution);
  while (const auto request = calibrator.next_request()) calibrator.accept(run_network(*request));
  return calibrator.result();
}

std::vector<LandmarkOffset> landmarks_on(const BodyModel& body, std::vector<LandmarkOffset> offsets) {
  for (LandmarkOffset& offset : offsets) {
    offset.joint = body.joint_for_smpl(offset.joint);
    offset.frame_joint = body.joint_for_smpl(offset.frame_joint);
  }
  return offsets;
}

}  // namespace vitruvian
