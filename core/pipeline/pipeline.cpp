#include "pipeline/pipeline.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "align/frame.h"
#include "base/error.h"
#include "pipeline/outcome.h"

namespace vitruvian {
namespace {

constexpr int kDetectorVertices = 6000;
constexpr int kFitSamples = 20000;
constexpr int kFacingViews = 8;
constexpr std::size_t kLargestPlacements = 3;
/// Surface fits that all placements and units of a scan may cost together, beyond their first ones.
constexpr int kRefitBudget = 72;
/// Detection scores this near to the best are worth a look when the best one leads to a bad fit.
constexpr double kWorthTrying = 0.25;

UnitCandidate fixed_unit(Unit unit, double extent) {
  return {to_string(unit), metres_per_unit(unit), extent * metres_per_unit(unit), 1.0};
}

/// Metres by which a stature lies outside the likely range.
double stature_excess(double stature) {
  return std::max({0.0, kLeastStature - stature, stature - kLargestStature});
}

}  // namespace

RegistrationPipeline::RegistrationPipeline(const Models& models, const Settings& settings,
                                           const Execution& execution)
    : models_(models), settings_(settings), execution_(execution) {
  if (settings.method != Method::ours || settings.solver != SolverKind::fast) {
    throw Error(ErrorCode::not_available, "the published method and solver are not yet available");
  }
  if (settings.detail != DetailMode::off)
    throw Error(ErrorCode::not_available, "--detail vertex is not yet available");
  if (settings.init != InitMode::automatic && settings.init != InitMode::keypoints) {
    throw Error(ErrorCode::not_available, "--init tpose is not yet available");
  }
  if (settings.views != 2 && settings.views != 8) throw Error(ErrorCode::usage, "--views must be 2 or 8");
  fit_model_ = std::make_unique<FitModel>(models.body, models.prior, settings.gender, settings.betas);
}

RegistrationPipeline::~RegistrationPipeline() = default;

void RegistrationPipeline::start_stage(double Timing::*stage) {
  const Clock::time_point now = Clock::now();
  if (current_stage_)
    timing_.*current_stage_ += std::chrono::duration<double, std::milli>(now - stage_began_).count();
  current_stage_ = stage;
  stage_began_ = now;
}

void RegistrationPipeline::set_scan(Scan scan) {
  began_ = Clock::now();
  start_stage(&Timing::align);
  execution_.progress("align", 0);
  refit_budget_ = kRefitBudget;
  scan_ = std::make_unique<PreparedScan>(std::move(scan), execution_);
  const ViewSurface& surface = scan_->surface;
  if (settings_.unit == Unit::automatic) {
    units_ = guess_unit(scan_->extent, scan_->scan.metres_per_unit);
  } else {
    units_.candidates = {fixed_unit(settings_.unit, scan_->extent)};
  }
  if (settings_.align == AlignMode::pca) {
    placements_ = {{align_pca(surface.vertices, models_.body.v_template), Vec3d::UnitY(), "pca"}};
    begin_views();
    return;
  }
  DecimatedMesh coarse =
      cluster_decimate(surface.vertices, surface.normals, surface.faces, kDetectorVertices);
  if (surface.faces.cols() > 0 && coarse.faces.cols() < coarse.vertices.cols() / 2) coarse.faces.resize(3, 0);
  detector_surface_ = std::make_unique<ViewSurface>(prepare_surface(
      std::move(coarse.vertices), std::move(coarse.faces), std::move(coarse.normals), execution_));
  up_detector_ = std::make_unique<UpDetector>(*detector_surface_, execution_);
}

void RegistrationPipeline::begin_placements() {
  const std::vector<UpHypothesis> ups = up_detector_->result();
  std::optional<Vec3d> front;
  if (settings_.front != Axis::automatic) front = axis_vector(to_string(settings_.front));
  if (settings_.up != Axis::automatic) {
    // The body frame is as the user says; the pictures are taken upright along the trunk all the same.
    const Mat3d rotation = body_from_scan_rotation(axis_vector(to_string(settings_.up)), front);
    placements_ = {{rotation, rotation * ups.front().up, "given"}};
    begin_views();
    return;
  }
  for (const UpHypothesis& hypothesis : ups) {
    if (placements_.size() >= kLargestPlacements) break;
    if (!placements_.empty() && hypothesis.score < kWorthTrying * ups.front().score) break;
    if (front && std::abs(front->dot(hypothesis.up)) > 0.9) continue;
    placements_.push_back({body_from_scan_rotation(hypothesis.up, front), Vec3d::UnitY(), "views"});
  }
  if (placements_.empty()) {
    throw Error(ErrorCode::usage,
                "--front lies along the body's up direction: give --up too, or another --front");
  }
  begin_views();
}

void RegistrationPipeline::begin_views() {
  start_stage(&Timing::project);
  execution_.progress("project", 0);
  const UnitCandidate& unit = units_.candidates.front();
  ViewSurface upright = scan_->surface;
  const Mat4d upright_from_scan =
      body_from_scan(placements_[placement_].rotation, scan_->centroid, unit.metres_per_unit);
  upright.vertices = transform_points(upright.vertices, scan_->scan.origin, upright_from_scan);
  upright.normals = (placements_[placement_].rotation.cast<float>() * upright.normals).eval();
  upright.point_radii *= static_cast<float>(unit.metres_per_unit);
  const int views = needs_facing() ? kFacingViews : settings_.views;
  landmark_stage_ = std::make_unique<LandmarkStage>(upright, placements_[placement_].trunk, views,
                                                    settings_.min_visibility, execution_);
  start_stage(&Timing::detect);
  execution_.progress("detect", 0);
}

std::optional<NetworkRequest> RegistrationPipeline::next_request() {
  execution_.check();
  while (!finished_) {
    if (!landmark_stage_) {
      if (auto request = up_detector_->next_request()) return request;
      begin_placements();
    }
    if (auto request = landmark_stage_->next_request()) return request;
    fit_placement();
  }
  return std::nullopt;
}

void RegistrationPipeline::accept(const NetworkReply& reply) {
  if (landmark_stage_) {
    landmark_stage_->accept(reply);
  } else {
    up_detector_->accept(reply);
  }
}

RegistrationPipeline::Candidate RegistrationPipeline::fit_candidate(const Placement& placement,
                                                                    const UnitCandidate& unit,
                                                                    SeenLandmarks seen, bool quick) {
  Candidate candidate;
  candidate.unit = unit;
  candidate.method = placement.method;
  candidate.body_from_scan = body_from_scan(placement.rotation, scan_->centroid, unit.metres_per_unit);
  const float ratio = static_cast<float>(unit.metres_per_unit / units_.candidates.front().metres_per_unit);
  for (auto* landmarks : {&seen.swap_aware, &seen.plain}) {
    for (Landmark3d& l : *landmarks) l.position *= ratio, l.residual *= ratio;
  }
  const auto facing = yaw_from_landmarks(seen.swap_aware);
  if (facing && settings_.front == Axis::automatic && settings_.align != AlignMode::pca) {
    candidate.body_from_scan = facing_forward(candidate.body_from_scan, facing->yaw);
    turn_forward(seen.swap_aware, facing->yaw);
    if (!seen.plain.empty()) turn_forward(seen.plain, facing->yaw);
  }
  candidate.landmarks = std::move(seen);
  const Points3f points =
      transform_points(scan_->scan.vertices, scan_->scan.origin, candidate.body_from_scan);
  const Mat3d linear = candidate.body_from_scan.topLeftCorner<3, 3>();
  const Points3f normals = (linear / unit.metres_per_unit).cast<float>() * scan_->normals;
  const ScanTarget target =
      ScanTarget::sample(points, scan_->scan.faces, normals, kFitSamples, settings_.seed);
  const auto targets = landmark_targets(models_.landmarks, candidate.landmarks.swap_aware);
  std::vector<LandmarkTarget> plain;
  if (!candidate.landmarks.plain.empty())
    plain = landmark_targets(models_.landmarks, candidate.landmarks.plain);
  HypothesisSettings hypotheses;
  hypotheses.refit_budget = quick ? 0 : std::min(hypotheses.refit_budget, refit_budget_);
  candidate.fit = fit_hypotheses(*fit_model_, target, targets, plain, hypotheses, execution_);
  refit_budget_ -= candidate.fit.refits;
  candidate.stature = standing_stature(models_.body, candidate.fit.state.betas);
  return candidate;
}

double RegistrationPipeline::rank(const Candidate& candidate) const {
  // Relative to the body's size, so that units do not compete by shrinking everything.
  return candidate.fit.score.total() / std::max(0.1, candidate.unit.extent_m) +
         stature_excess(candidate.stature) / 5;
}

bool RegistrationPipeline::needs_facing() const {
  return settings_.views == 2 && settings_.align != AlignMode::pca && settings_.front == Axis::automatic &&
         !placements_[placement_].facing_known;
}

void RegistrationPipeline::fit_placement() {
  start_stage(&Timing::pose);
  const SeenLandmarks seen = landmark_stage_->result();
  if (needs_facing()) {
    // Front and side view need a body that faces forward; a first look all round tells where that is.
    Placement& placement = placements_[placement_];
    placement.facing_known = true;
    if (const auto facing = yaw_from_landmarks(seen.swap_aware)) {
      placement.rotation =
          Eigen::AngleAxisd(-facing->yaw, Vec3d::UnitY()).toRotationMatrix() * placement.rotation;
    }
    begin_views();
    return;
  }
  start_stage(&Timing::fit);
  execution_.progress("fit", 0);
  // Units are told apart by one quick fit each; only the likeliest is worth searching for misplaced limbs.
  UnitCandidate unit = units_.candidates.front();
  if (units_.candidates.size() > 1) {
    double least = 0;
    for (const UnitCandidate& candidate : units_.candidates) {
      const double value = rank(fit_candidate(placements_[placement_], candidate, seen, true));
      if (&candidate == &units_.candidates.front() || value < least) unit = candidate, least = value;
    }
  }
  Candidate candidate = fit_candidate(placements_[placement_], unit, seen, false);
  if (!best_ || rank(candidate) < rank(*best_)) best_ = std::move(candidate);
  ++placement_;
  if (!best_->fit.bad || placement_ >= placements_.size()) {
    finished_ = true;
    return;
  }
  begin_views();
}

Registration RegistrationPipeline::finish() {
  if (!finished_)
    throw Error(ErrorCode::internal, "the pipeline was finished before its last request was answered");
  start_stage(&Timing::refine);
  execution_.progress("refine", 0);
  OutcomeInput input{models_,    *fit_model_,     settings_, *scan_, best_->body_from_scan,
                     best_->fit, best_->landmarks};
  input.unit = best_->unit;
  input.unit_note = units_.note;
  input.method = best_->method;
  input.stature = best_->stature;
  Registration registration = make_outcome(input, execution_);
  start_stage(nullptr);
  timing_.total = timing_.read + std::chrono::duration<double, std::milli>(Clock::now() - began_).count();
  registration.timing_ms = timing_;
  execution_.progress("refine", 1);
  return registration;
}

Registration register_scan(Scan scan, const Models& models, const Settings& settings,
                           const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                           const Execution& execution, double read_ms) {
  RegistrationPipeline pipeline(models, settings, execution);
  pipeline.set_read_time(read_ms);
  pipeline.set_scan(std::move(scan));
  while (const auto request = pipeline.next_request()) pipeline.accept(run_network(*request));
  return pipeline.finish();
}

}  // namespace vitruvian
