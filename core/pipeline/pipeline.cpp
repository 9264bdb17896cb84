#include "pipeline/pipeline.h"

#include <algorithm>

#include "align/frame.h"
#include "base/error.h"
#include "fit/scan_target.h"
#include "pipeline/check_settings.h"
#include "pipeline/outcome.h"
#include "pipeline/paper_pipeline.h"
#include "pipeline/regions.h"
#include "pipeline/start_state.h"

namespace vitruvian {
namespace {

constexpr int kDetectorVertices = 6000;
constexpr int kFitSamples = 20000;
/// Surface fits that all placements and units of a scan may cost together, beyond their first ones.
constexpr int kRefitBudget = 72;

UnitCandidate fixed_unit(Unit unit, double extent) {
  return {to_string(unit), metres_per_unit(unit), extent * metres_per_unit(unit), 1.0};
}

/// Labels of those of the scan's vertices that were kept.
void keep_labels(RegionLabels& labels, const std::vector<int>& kept) {
  if (labels.scan.empty() || kept.empty()) return;
  std::vector<int> of_kept;
  of_kept.reserve(kept.size());
  for (const int vertex : kept) of_kept.push_back(labels.scan[static_cast<std::size_t>(vertex)]);
  labels.scan = std::move(of_kept);
}

/// Metres by which a stature lies outside the likely range.
double stature_excess(double stature) {
  return std::max({0.0, kLeastStature - stature, stature - kLargestStature});
}

}  // namespace

RegistrationPipeline::Search::Search() : refit_budget(kRefitBudget) {}

RegistrationPipeline::RegistrationPipeline(const Models& models, const Settings& settings,
                                           const Execution& execution)
    : models_(models), settings_(settings), execution_(execution) {
  check_settings(settings, models);
  fit_model_ = std::make_unique<FitModel>(models.body, models.prior, settings.gender, settings.betas);
}

RegistrationPipeline::~RegistrationPipeline() = default;

void RegistrationPipeline::set_scan(std::shared_ptr<const Scan> scan) {
  whole_ = std::move(scan);
  prepare();
}

void RegistrationPipeline::prepare() {
  clock_ = StageClock();
  clock_.enter(&Timing::align);
  execution_.progress("align", 0);
  detector_surface_.reset();
  up_detector_.reset();
  attempts_.clear();
  search_ = Search();
  scan_.reset();
  source_ = crop_scan(whole_, settings_.crops);
  scan_ = std::make_unique<PreparedScan>(source_.scan, execution_);
  clock_.pause();
}

void RegistrationPipeline::configure(const Settings& settings) {
  const auto affected = first_affected(settings_, settings);
  if (!affected) return;
  check_settings(settings, models_);
  auto fit_model = std::make_unique<FitModel>(models_.body, models_.prior, settings.gender, settings.betas);
  forget(*affected);
  fit_model_ = std::move(fit_model);
  if (settings_.crops != settings.crops) scan_.reset();
  settings_ = settings;
}

void RegistrationPipeline::forget(PipelineStage stage) {
  clock_.forget(stage);
  search_ = Search();
  if (stage == PipelineStage::align) {
    attempts_.clear();
  } else {
    for (Attempt& attempt : attempts_) attempt.forget(stage);
  }
}

AttemptContext RegistrationPipeline::context() {
  return {models_, *fit_model_, settings_, *scan_, units_.candidates.front(), execution_, clock_};
}

void RegistrationPipeline::choose_units() {
  if (settings_.body_from_scan) {
    units_ = UnitGuess();
    units_.candidates = {unit_of(*settings_.body_from_scan, scan_->extent)};
  } else if (settings_.unit == Unit::automatic) {
    units_ = guess_unit(scan_->extent, scan_->scan.metres_per_unit);
    // Section 3.1.1: by the extent alone.
    if (settings_.method != Method::ours) units_.candidates.resize(1);
  } else {
    units_ = UnitGuess();
    units_.candidates = {fixed_unit(settings_.unit, scan_->extent)};
  }
}

/// Lists the attempts. @return false when a network has to be run first.
bool RegistrationPipeline::find_placements(std::optional<NetworkRequest>& request) {
  const ViewSurface& surface = scan_->surface;
  choose_units();
  clock_.work_for(std::nullopt);
  clock_.enter(&Timing::align);
  if (settings_.align == AlignMode::pca) {
    attempts_.emplace_back(
        Placement{align_pca(surface.vertices, models_.body.v_template), Vec3d::UnitY(), "pca", {}});
    return true;
  }
  if (!needs_pictures(settings_)) {
    attempts_.emplace_back(given_placement(settings_));
    return true;
  }
  if (!up_detector_) {
    DecimatedMesh coarse =
        cluster_decimate(surface.vertices, surface.normals, surface.faces, kDetectorVertices);
    if (surface.faces.cols() > 0 && coarse.faces.cols() < coarse.vertices.cols() / 2)
      coarse.faces.resize(3, 0);
    detector_surface_ = std::make_unique<ViewSurface>(prepare_surface(
        std::move(coarse.vertices), std::move(coarse.faces), std::move(coarse.normals), execution_));
    up_detector_ = std::make_unique<UpDetector>(*detector_surface_, execution_);
  }
  request = up_detector_->next_request();
  if (request) return false;
  for (Placement& placement : list_placements(up_detector_->result(), settings_))
    attempts_.emplace_back(std::move(placement));
  return true;
}

std::optional<NetworkRequest> RegistrationPipeline::next_request(PipelineStage until) {
  execution_.check();
  if (!whole_) throw Error(ErrorCode::internal, "the pipeline has no scan");
  std::optional<NetworkRequest> request;
  try {
    if (!scan_) prepare();
    request = work(until);
  } catch (...) {
    clock_.pause();
    throw;
  }
  // While a network runs, the time goes to the stage that asked for it.
  if (!request) clock_.pause();
  return request;
}

std::optional<NetworkRequest> RegistrationPipeline::work(PipelineStage until) {
  std::optional<NetworkRequest> request;
  // Told at once when they were painted on another scan.
  regions_ = settings_.regions ? region_labels(*settings_.regions, *whole_, models_.body) : RegionLabels();
  keep_labels(regions_, source_.kept);
  if (attempts_.empty() && !find_placements(request)) return request;
  for (const PipelineStage stage : {PipelineStage::align, PipelineStage::keypoints, PipelineStage::pose}) {
    clock_.work_for(stage);
    if ((request = attempts_.front().next_request(stage, context()))) return request;
    if (stage == until) return std::nullopt;
  }
  clock_.work_for(PipelineStage::fit);
  while (!search_.done) {
    if ((request = attempts_[search_.at].next_request(PipelineStage::pose, context()))) return request;
    fit_attempt();
  }
  return std::nullopt;
}

void RegistrationPipeline::accept(const NetworkReply& reply) {
  if (!attempts_.empty()) {
    attempts_[search_.at].accept(reply);
  } else if (up_detector_) {
    up_detector_->accept(reply);
  } else {
    throw Error(ErrorCode::internal, "a reply to a request that was not made");
  }
}

RegistrationPipeline::Candidate RegistrationPipeline::fit_candidate(std::size_t index,
                                                                    const UnitCandidate& unit, bool quick) {
  const Attempt& attempt = attempts_[index];
  Candidate candidate;
  candidate.attempt = index;
  candidate.unit = unit;
  candidate.body_from_scan = attempt.body_from_scan(scan_->centroid, unit.metres_per_unit);
  candidate.landmarks = attempt.landmarks();
  HypothesisSettings hypotheses;
  hypotheses.refit_budget = quick ? 0 : std::min(hypotheses.refit_budget, search_.refit_budget);
  const double seen_in = units_.candidates.front().metres_per_unit;
  const bool as_seen = unit.metres_per_unit == seen_in;
  if (!as_seen) {
    const float ratio = static_cast<float>(unit.metres_per_unit / seen_in);
    for (auto* landmarks : {&candidate.landmarks.swap_aware, &candidate.landmarks.plain}) {
      for (Landmark3d& l : *landmarks) l.position *= ratio, l.residual *= ratio;
    }
  }
  const Points3f points =
      transform_points(scan_->scan.vertices, scan_->scan.origin, candidate.body_from_scan);
  const Mat3d linear = candidate.body_from_scan.topLeftCorner<3, 3>();
  const Points3f normals = (linear / unit.metres_per_unit).cast<float>() * scan_->normals;
  candidate.seen = pose_targets(models_, settings_, candidate.landmarks, candidate.body_from_scan);
  const Vec3d centroid = transformed(candidate.body_from_scan, scan_->centroid);
  candidate.initial =
      as_seen ? attempt.pose()
              : vitruvian::initial_pose(*fit_model_, settings_, candidate.seen, centroid, execution_);
  if (settings_.solver == SolverKind::paper && attempts_.size() == 1 && units_.candidates.size() == 1) {
    // Nothing to choose: the published fit is all there is to do.
    candidate.fit.state = candidate.initial;
    return candidate;
  }
  const ScanTarget target =
      sample_body(*scan_, points, normals, candidate.body_from_scan, kFitSamples, settings_.seed, regions_);
  const std::vector<LandmarkTarget>& targets = candidate.seen.targets;
  if (start_is_given(settings_)) {
    candidate.fit = fit_from_state(*fit_model_, target, candidate.initial, to_string(settings_.init), targets,
                                   hypotheses, execution_);
  } else {
    std::vector<LandmarkTarget> plain;
    if (!candidate.landmarks.plain.empty())
      plain = landmark_targets(models_.landmarks, candidate.landmarks.plain);
    hypotheses.landmark_fit = candidate.initial;
    candidate.fit = fit_hypotheses(*fit_model_, target, targets, plain, hypotheses, execution_);
  }
  search_.refit_budget -= candidate.fit.refits;
  candidate.stature = standing_stature(models_.body, candidate.fit.state.betas);
  return candidate;
}

double RegistrationPipeline::rank(const Candidate& candidate) const {
  // Relative to the body's size, so that units do not compete by shrinking everything.
  return candidate.fit.score.total() / std::max(0.1, candidate.unit.extent_m) +
         stature_excess(candidate.stature) / 5;
}

void RegistrationPipeline::fit_attempt() {
  clock_.enter(&Timing::fit);
  execution_.progress("fit", 0);
  // Units are told apart by one quick fit each; only the likeliest is worth searching for misplaced limbs.
  UnitCandidate unit = units_.candidates.front();
  if (units_.candidates.size() > 1) {
    double least = 0;
    for (const UnitCandidate& candidate : units_.candidates) {
      const double value = rank(fit_candidate(search_.at, candidate, true));
      if (&candidate == &units_.candidates.front() || value < least) unit = candidate, least = value;
    }
  }
  Candidate candidate = fit_candidate(search_.at, unit, false);
  if (!search_.best || rank(candidate) < rank(*search_.best)) search_.best = std::move(candidate);
  // In a wrong placement whole limbs are away.
  if (!(search_.best->fit.bad && search_.best->fit.limb_away) || search_.at + 1 >= attempts_.size()) {
    if (settings_.solver == SolverKind::paper) fit_as_published(*search_.best);
    search_.done = true;
  } else {
    ++search_.at;
  }
}

void RegistrationPipeline::fit_as_published(Candidate& candidate) {
  const Points3f points =
      transform_points(scan_->scan.vertices, scan_->scan.origin, candidate.body_from_scan);
  clock_.enter(&Timing::fit);
  execution_.progress("fit", 0);
  const PaperFit distance =
      paper_distance_fit(*fit_model_, points, regions_, candidate.initial, settings_, execution_, energy_);
  clock_.enter(&Timing::refine);
  execution_.progress("refine", 0);
  const PaperRefinement refined =
      paper_correspondence_fit(*fit_model_, points, regions_, distance.state, settings_, execution_, energy_);
  candidate.fit.state = refined.second_pass.state;
  candidate.stature = standing_stature(models_.body, candidate.fit.state.betas);
}

Registration RegistrationPipeline::finish() {
  if (!search_.done)
    throw Error(ErrorCode::internal, "the pipeline was finished before its last request was answered");
  clock_.work_for(PipelineStage::fit);
  clock_.enter(&Timing::refine);
  execution_.progress("refine", 0);
  const Candidate& best = *search_.best;
  OutcomeInput input{models_,  *fit_model_,       settings_,           *scan_,  best.body_from_scan,
                     best.fit, best.seen.targets, best.seen.keypoints, regions_};
  input.refine = settings_.solver == SolverKind::fast;
  input.unit = best.unit;
  input.unit_note = units_.note;
  input.method = attempts_[best.attempt].method();
  input.stature = best.stature;
  input.begin_stage = [this](double Timing::*stage) { clock_.enter(stage); };
  Registration registration = make_outcome(input, execution_);
  registration.scan.vertices = static_cast<long>(whole_->vertices.cols());
  registration.scan.faces = static_cast<long>(whole_->faces.cols());
  clock_.pause();
  registration.timing_ms = clock_.sum();
  registration.timing_ms.read = read_ms_;
  registration.timing_ms.total += read_ms_;
  execution_.progress(settings_.detail == DetailMode::off ? "refine" : "detail", 1);
  return registration;
}

const Attempt& RegistrationPipeline::shown() const {
  return search_.done ? attempts_[search_.best->attempt] : attempts_.front();
}

const UnitCandidate& RegistrationPipeline::shown_unit() const {
  return search_.done ? search_.best->unit : units_.candidates.front();
}

bool RegistrationPipeline::reached(PipelineStage stage) const {
  if (stage == PipelineStage::fit) return search_.done;
  return !attempts_.empty() && shown().reached(stage);
}

void RegistrationPipeline::require(PipelineStage stage) const {
  if (!reached(stage)) throw Error(ErrorCode::internal, "a stage's finding was asked for before the stage");
}

RegistrationPipeline::AlignFinding RegistrationPipeline::align_finding() const {
  require(PipelineStage::align);
  const UnitCandidate& unit = shown_unit();
  const Mat4d body_from_scan = shown().body_from_scan(scan_->centroid, unit.metres_per_unit);
  const Eigen::VectorXf along = body_from_scan.block<1, 3>(1, 0).cast<float>() * scan_->surface.vertices;
  return {describe_alignment(body_from_scan, unit, shown().method()), along.maxCoeff() - along.minCoeff(),
          shown().front_is_known(), units_.note};
}

const LandmarkStage* RegistrationPipeline::landmark_stage() const {
  if (search_.done) return attempts_[search_.best->attempt].pictures();
  return attempts_.empty() ? nullptr : attempts_[search_.at].pictures();
}

std::vector<Keypoint> RegistrationPipeline::keypoints() const { return targets().keypoints; }

PoseTargets RegistrationPipeline::targets() const {
  require(PipelineStage::keypoints);
  if (search_.done) return search_.best->seen;
  const Mat4d frame = shown().body_from_scan(scan_->centroid, shown_unit().metres_per_unit);
  return pose_targets(models_, settings_, shown().landmarks(), frame);
}

const BodyState& RegistrationPipeline::initial_pose() const {
  require(PipelineStage::pose);
  return search_.done ? search_.best->initial : shown().pose();
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
