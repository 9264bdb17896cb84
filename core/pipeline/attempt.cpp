#include "pipeline/attempt.h"

#include <Eigen/Geometry>

#include "align/frame.h"
#include "base/error.h"
#include "pipeline/start_state.h"

namespace vitruvian {
namespace {

/// Views from which the facing is found.
constexpr int kFacingViews = 8;

}  // namespace

Mat4d Attempt::body_from_scan(const Vec3d& centroid_scan, double metres_per_unit) const {
  if (placement_.body_from_scan) return *placement_.body_from_scan;
  const Heading& heading = seen_ ? *seen_ : *aligned_;
  const Mat4d upright_from_scan = vitruvian::body_from_scan(heading.rotation, centroid_scan, metres_per_unit);
  return heading.yaw ? facing_forward(upright_from_scan, *heading.yaw) : upright_from_scan;
}

bool Attempt::reached(PipelineStage stage) const {
  switch (stage) {
    case PipelineStage::align:
      return aligned_.has_value();
    case PipelineStage::keypoints:
      return landmarks_.has_value();
    default:
      return pose_.has_value();
  }
}

void Attempt::forget(PipelineStage stage) {
  if (stage == PipelineStage::fit) return;
  pose_.reset();
  if (stage == PipelineStage::pose) return;
  landmarks_.reset();
  seen_.reset();
  look_.reset();
  if (stage == PipelineStage::align) aligned_.reset();
}

void Attempt::accept(const NetworkReply& reply) {
  if (!look_) throw Error(ErrorCode::internal, "a reply to a request that was not made");
  look_->stage.accept(reply);
}

std::optional<NetworkRequest> Attempt::next_request(PipelineStage until, const AttemptContext& context) {
  if (!aligned_) {
    if (turns_by_sight(context.settings)) {
      if (!look_) look(kFacingViews, placement_.rotation, context);
      if (auto request = look_->stage.next_request()) return request;
    }
    align(context);
  }
  if (until == PipelineStage::align) return std::nullopt;
  if (!landmarks_ && !looks_for_landmarks(context.settings)) {
    seen_ = aligned_;
    landmarks_ = SeenLandmarks();
  }
  if (!landmarks_) {
    const int views = context.settings.views;
    if (!look_ || look_->views != views) {
      // The published views need a body that faces forward.
      Mat3d rotation = placement_.rotation;
      if (views == 2 && aligned_->yaw)
        rotation = Eigen::AngleAxisd(-*aligned_->yaw, Vec3d::UnitY()).toRotationMatrix() * rotation;
      look(views, rotation, context);
    }
    if (auto request = look_->stage.next_request()) return request;
    find_keypoints(context);
  }
  if (until == PipelineStage::keypoints) return std::nullopt;
  if (!pose_) {
    context.clock.enter(&Timing::pose);
    context.execution.progress("pose", 0);
    const Mat4d frame = body_from_scan(context.scan.centroid, context.unit.metres_per_unit);
    pose_ = initial_pose(context.fit_model, context.settings,
                         pose_targets(context.models, context.settings, *landmarks_, frame),
                         transformed(frame, context.scan.centroid), context.execution);
  }
  return std::nullopt;
}

void Attempt::look(int views, const Mat3d& rotation, const AttemptContext& context) {
  context.clock.enter(&Timing::project);
  context.execution.progress("project", 0);
  ViewSurface upright = context.scan.surface;
  const double metres_per_unit = context.unit.metres_per_unit;
  upright.vertices =
      transform_points(upright.vertices, context.scan.scan.origin,
                       placement_.body_from_scan
                           ? *placement_.body_from_scan
                           : vitruvian::body_from_scan(rotation, context.scan.centroid, metres_per_unit));
  upright.normals = (rotation.cast<float>() * upright.normals).eval();
  upright.point_radii *= static_cast<float>(metres_per_unit);
  look_.reset(new Look{
      LandmarkStage(upright, placement_.trunk, views, context.settings.min_visibility, context.execution),
      views, rotation, std::nullopt});
  context.clock.enter(&Timing::detect);
  context.execution.progress("detect", 0);
}

void Attempt::align(const AttemptContext& context) {
  Heading heading{placement_.rotation, std::nullopt};
  front_is_known_ = true;
  if (turns_by_sight(context.settings)) {
    look_->seen = look_->stage.result();
    if (const auto facing = yaw_from_landmarks(look_->seen->swap_aware)) heading.yaw = facing->yaw;
    front_is_known_ = heading.yaw.has_value();
  }
  aligned_ = heading;
}

void Attempt::find_keypoints(const AttemptContext& context) {
  if (!look_->seen) look_->seen = look_->stage.result();
  SeenLandmarks landmarks = *look_->seen;
  Heading heading{look_->rotation, std::nullopt};
  if (const auto facing = yaw_from_landmarks(landmarks.swap_aware);
      facing && turns_by_sight(context.settings)) {
    heading.yaw = facing->yaw;
    turn_forward(landmarks.swap_aware, facing->yaw);
    if (!landmarks.plain.empty()) turn_forward(landmarks.plain, facing->yaw);
  }
  seen_ = heading;
  landmarks_ = std::move(landmarks);
}

}  // namespace vitruvian
