#include "pipeline/lesson.h"

#include <algorithm>
#include <cmath>

#include "align/frame.h"
#include "base/random.h"
#include "pipeline/regions.h"
#include "pipeline/start_state.h"

namespace vitruvian {
namespace {

constexpr int kSamples = 20000;
/// Beyond this the nearest sample's tangent plane says nothing about the surface.
constexpr float kPlaneReach = 0.05f;  // m

void check(const LessonSettings& settings) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!within(settings.keypoint_noise_m, 0, 1)) throw Error(ErrorCode::usage, "keypoint noise: 0 to 1 m");
  if (!within(settings.prior_weight, 0, 100)) throw Error(ErrorCode::usage, "prior weight: 0 to 100");
  if (settings.iterations < 1) throw Error(ErrorCode::usage, "iterations: 1 or more");
}

/// The full schedule, cut after so many iterations.
FitSchedule changed_schedule(const LessonSettings& settings) {
  FitSchedule schedule = FitSchedule::full();
  int left = settings.iterations;
  for (FitStage& stage : schedule.stages) {
    stage.iterations = std::min(stage.iterations, left);
    left -= stage.iterations;
    stage.gaussian *= settings.prior_weight;
    stage.limits *= settings.prior_weight;
    stage.shape *= settings.prior_weight;
    stage.from_scan = !settings.one_directional;
  }
  return schedule;
}

std::vector<LandmarkTarget> changed_targets(std::vector<LandmarkTarget> targets,
                                            const LessonSettings& settings) {
  if (settings.tpose) return {};
  Random random(settings.seed);
  for (LandmarkTarget& l : targets) {
    for (int k = 0; k < 3; ++k) l.target[k] += settings.keypoint_noise_m * random.normal();
  }
  return targets;
}

std::vector<float> residuals(const FitModel& model, const ScanTarget& scan, const BodyState& state) {
  PosedModel posed;
  posed.update(model, state);
  std::vector<float> result;
  for (Index v = 0; v < posed.vertices.cols(); ++v) {
    const Vec3f x = posed.vertices.col(v);
    const Neighbour near = scan.by_position.nearest(x);
    const Vec3f apart = x - scan.points.col(near.index);
    const float distance = apart.norm();
    result.push_back(distance < kPlaneReach ? std::abs(scan.normals.col(near.index).dot(apart)) : distance);
  }
  return result;
}

}  // namespace

JointsApart joints_apart(const Lesson& a, const Lesson& b) {
  if (a.steps.empty() || b.steps.empty() || a.steps.back().joints.cols() != b.steps.back().joints.cols())
    throw Error(ErrorCode::internal, "lessons about different bodies cannot be compared");
  const Eigen::RowVectorXf apart = (a.steps.back().joints - b.steps.back().joints).colwise().norm();
  return {apart.maxCoeff(), apart.mean()};
}

Lesson run_lesson(const RegistrationPipeline& pipeline, const LessonSettings& settings,
                  const Execution& execution) {
  check(settings);
  const FitModel& model = pipeline.fit_model();
  const PreparedScan& prepared = pipeline.prepared();
  const Mat4d body_from_scan = pipeline.align_finding().alignment.body_from_scan;
  const Mat3d rotation = rotation_of(body_from_scan);
  const RegionLabels regions = pipeline.settings().regions
                                   ? region_labels(*pipeline.settings().regions, prepared.scan, model.body)
                                   : RegionLabels();
  const ScanTarget target = ScanTarget::sample(
      transform_points(prepared.scan.vertices, prepared.scan.origin, body_from_scan), prepared.scan.faces,
      (rotation.cast<float>() * prepared.normals).eval(), kSamples, pipeline.settings().seed, regions);

  Lesson lesson;
  lesson.targets = changed_targets(pipeline.targets().targets, settings);
  FitTrace trace(model);
  const FitObserver each = trace.observer();
  BodyState state;
  if (settings.tpose) {
    state = rest_pose_at(model, transformed(body_from_scan, prepared.centroid));
  } else {
    LandmarkFitSettings landmark_fit;
    landmark_fit.gaussian *= settings.prior_weight;
    landmark_fit.limits *= settings.prior_weight;
    landmark_fit.shape *= settings.prior_weight;
    state = fit_landmarks(model, lesson.targets, landmark_fit, each);
  }
  execution.check();
  fit_surface(model, target, changed_schedule(settings), lesson.targets, state, execution, each);
  trace.finish(state);
  lesson.steps = trace.steps();
  lesson.residual_m = residuals(model, target, state);
  return lesson;
}

}  // namespace vitruvian
