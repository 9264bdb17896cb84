#include "pipeline/outcome.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "align/frame.h"
#include "detail/vertex_offsets.h"
#include "keypoints/left_right.h"
#include "measure/inside.h"
#include "measure/surface_error_compute.h"
#include "measure/verdict_features.h"
#include "pipeline/body_parameters.h"

namespace vitruvian {
namespace {

constexpr int kRefineSamples = 20000;
constexpr double kSureKeypoint = 0.5;

/// A file that is of one gender says so, unless the user says otherwise.
ModelInfo describe_model(const Models& models, Gender wanted, const BodyState& state) {
  const BodyModel& body = models.body;
  ModelInfo info;
  info.name = body.name;
  info.family = body.family;
  info.sha256 = body.sha256;
  info.gender = wanted == Gender::neutral ? body.gender.value_or(wanted) : wanted;
  info.vertices = body.vertex_count();
  info.faces = body.face_count();
  info.betas = static_cast<int>(std::min<Index>(state.betas.size(), body.shape_count()));
  info.joints = body.joint_count();
  info.dmpl = models.dmpl;
  info.prior = models.users_prior;
  return info;
}

std::vector<JointFinding> limit_excess(const BodyModel& body, const PosePrior& prior,
                                       const BodyState& state) {
  std::vector<JointFinding> findings;
  const Points3d pose = state.axis_angle();
  for (int j = 1; j < body.joint_count() && 3 * j <= prior.limit_low.size(); ++j) {
    double worst = 0;
    for (int k = 0; k < 3; ++k) {
      const int i = 3 * (j - 1) + k;
      worst = std::max({worst, prior.limit_low[i] - pose(k, j), pose(k, j) - prior.limit_high[i]});
    }
    if (worst > 0) findings.push_back({body.joint_names[j], worst});
  }
  return findings;
}

std::vector<JointFinding> keypoint_disagreement(const std::vector<LandmarkTarget>& targets,
                                                const BodyModel& body, const Skeleton& skeleton,
                                                const VerdictFeatures& features) {
  std::vector<JointFinding> findings;
  for (const LandmarkTarget& l : targets) {
    if (l.weight < kSureKeypoint) continue;
    // Where a part was not scanned the detector guessed as the fit did; the segments are in joint order.
    const std::size_t s = static_cast<std::size_t>(l.joint);
    if (s < features.observed_share.size() && features.observed_share[s] < kObservedShare) continue;
    const double distance = (landmark_position(skeleton, l) - l.target).norm();
    const std::string& name = body.joint_names[l.joint];
    // A wrist has landmarks on the fingers too: the worst speaks for it.
    const auto known = std::find_if(findings.begin(), findings.end(),
                                    [&](const JointFinding& finding) { return finding.joint == name; });
    if (known == findings.end()) {
      findings.push_back({name, distance});
    } else {
      known->value = std::max(known->value, distance);
    }
  }
  return findings;
}

/// Which template vertices lie over a hole of the scan or beyond its rim.
std::vector<std::uint8_t> unseen_vertices(const BodyModel& body, const Points3d& posed,
                                          const ScanTarget& samples) {
  std::vector<std::uint8_t> unseen(static_cast<std::size_t>(posed.cols()), 0);
  if (samples.at_rim.empty()) return unseen;
  const Points3f vertices = posed.cast<float>(), normals = vertex_normals(vertices, body.faces);
  for (Index v = 0; v < vertices.cols(); ++v) {
    const int y = samples.by_position_and_normal.nearest(vertices.col(v), normals.col(v)).index;
    unseen[v] = samples.unseen(y, (vertices.col(v) - samples.points.col(y)).squaredNorm()) ? 1 : 0;
  }
  return unseen;
}

/// Hands and feet that still misfit where the search for other starts ended without a good one. Shoes and
/// sleeves misfit always: they speak only when more does.
std::vector<std::string> misfit_parts(const HypothesisResult& fit) {
  const HypothesisSettings limits;
  const bool bare = fit.score.typical < limits.bare_typical;
  std::vector<std::string> parts;
  if (!fit.bad || fit.limb_away || !(bare || fit.score.opposed_normals > limits.bad_opposed_clothed))
    return parts;
  constexpr std::array<const char*, 4> kNames = {"left hand", "right hand", "left foot", "right foot"};
  for (std::size_t limb = 0; limb < kNames.size(); ++limb) {
    if (fit.misfit_limbs[limb]) parts.emplace_back(kNames[limb]);
  }
  return parts;
}

Points3d scan_from_body(const OutcomeInput& input, const Points3d& body_points) {
  const Mat4d inverse = input.body_from_scan.inverse();
  return (inverse.topLeftCorner<3, 3>() * body_points).colwise() + inverse.topRightCorner<3, 1>();
}

SurfaceMeasurement measured_body(const BodyModel& body, const Points3d& vertices, const ScanSurface& scan,
                                 const Execution& execution) {
  const Points3f vertices_float = vertices.cast<float>();
  const Points3f normals = vertex_normals(vertices_float, body.faces);
  return measure_surface({vertices_float, normals, body.faces, body.segment}, scan, execution);
}

}  // namespace

Alignment describe_alignment(const Mat4d& body_from_scan, const UnitCandidate& unit,
                             const std::string& method) {
  Alignment alignment;
  alignment.body_from_scan = body_from_scan;
  alignment.canonical_from_body.topLeftCorner<3, 3>() = canonical_from_body_rotation();
  alignment.unit = unit_named(unit.unit);
  alignment.metres_per_unit = unit.metres_per_unit;
  const Mat3d rotation = body_from_scan.topLeftCorner<3, 3>();
  alignment.up = nearest_axis(rotation.row(1).transpose());
  alignment.front = nearest_axis(rotation.row(2).transpose());
  alignment.method = method;
  return alignment;
}

double standing_stature(const BodyModel& body, const Eigen::VectorXd& betas) {
  VertexMatrix<float> rest;
  shape_vertices(body, betas, rest);
  return rest.row(1).maxCoeff() - rest.row(1).minCoeff();
}

Unit unit_named(const std::string& name) {
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch}) {
    if (to_string(unit) == name) return unit;
  }
  return Unit::automatic;
}

Registration make_outcome(const OutcomeInput& input, const Execution& execution) {
  const BodyModel& body = input.models.body;
  const PlacedScan placed(input.scan, input.body_from_scan, execution);
  const ScanSurface surface = placed.surface();
  const ScanTarget samples = sample_body(input.scan, placed.points(), placed.normals(), input.body_from_scan,
                                         kRefineSamples, input.settings.seed + 17, input.regions);
  BodyState state = input.fit.state;
  if (input.refine) {
    refine_fit(input.fit_model, surface, samples, RefineSettings(), state, execution, input.regions);
  }

  // The result is what the double-precision forward model says, so that it can be rebuilt from the
  // parameters.
  Points3d vertices = posed_vertices<double>(body, state);
  SurfaceMeasurement measured = measured_body(body, vertices, surface, execution);

  const Skeleton skeleton = pose_skeleton(body, state);
  VerdictFeatures features = features_from(measured, body.segment);
  leave_out_unseen(unseen_vertices(body, vertices, samples), body.segment, measured, features);
  features.typical_mm = 1e3 * input.fit.score.typical;
  features.misfit_parts = misfit_parts(input.fit);
  features.limb_misfit = input.fit.limb_misfit;
  features.runner_up_gap_mm = 1e3 * input.fit.runner_up_gap;
  features.refits = input.fit.refits;
  features.joint_limit_excess_rad = limit_excess(body, input.models.prior, state);
  features.keypoint_disagreement_m = keypoint_disagreement(input.targets, body, skeleton, features);
  const Points3f vertices_float = vertices.cast<float>();
  features.inside_share =
      inside_share(vertices_float, vertex_normals(vertices_float, body.faces), body.faces);
  features.stature_m = standing_stature(body, state.betas);
  if (!input.unit_note.empty()) features.notes.push_back(input.unit_note);

  Registration result;
  const Scan& scan = input.scan.scan;
  result.scan = {scan.file_name, scan.sha256, static_cast<long>(scan.vertices.cols()),
                 static_cast<long>(scan.faces.cols())};
  result.model = describe_model(input.models, input.settings.gender, state);
  result.alignment = describe_alignment(input.body_from_scan, input.unit, input.method);
  result.keypoints = input.keypoints;
  result.parameters = parameters_of(body, state);
  const Points3d joints_scan = scan_from_body(input, skeleton.joints);
  for (int j = 0; j < body.joint_count(); ++j) {
    result.joints.push_back({body.joint_names[j], skeleton.joints.col(j), joints_scan.col(j)});
  }
  result.verdict = judge(features);
  result.verdict_features = std::move(features);
  // Offsets on top of a wrong pose would only dress it up.
  if (input.settings.detail == DetailMode::vertex && result.verdict.status != VerdictStatus::failed) {
    input.begin_stage(&Timing::detail);
    DetailSettings detail;
    detail.seed = input.settings.seed + 29;
    result.offsets = vertex_offsets(body, state, surface, detail, execution);
    result.parameters->offsets_file = kOffsetsFile;
    result.parametric_error = measured.error;
    vertices = posed_vertices<double>(body, state, result.offsets);
    measured = measured_body(body, vertices, surface, execution);
  }
  result.surface_error = measured.error;
  result.settings = input.settings;
  result.registered_vertices = scan_from_body(input, vertices);
  result.registered_faces = body.faces;
  for (const float distance : measured.surface_distance_m) result.vertex_error_mm.push_back(1000 * distance);
  return result;
}

}  // namespace vitruvian
