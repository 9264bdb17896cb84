#include "pipeline/start_state.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fit/landmark_fit.h"
#include "pipeline/body_parameters.h"
#include "pipeline/paper_pipeline.h"
#include "pipeline/settings.h"

namespace vitruvian {
namespace {

double scale_of(const Mat4d& similarity) { return std::cbrt(similarity.topLeftCorner<3, 3>().determinant()); }

}  // namespace

BodyState rest_pose_at(const FitModel& model, const Vec3d& centroid) {
  BodyState state = BodyState::rest(model.body);
  state.betas = Eigen::VectorXd::Zero(model.betas);
  const Eigen::VectorXd areas = model.body.vertex_area.cast<double>();
  state.translation = centroid - model.body.v_template.cast<double>() * areas / areas.sum();
  return state;
}

BodyState state_of(const FitModel& model, const BodyParameters& parameters) {
  BodyParameters kept = parameters;
  kept.betas.conservativeResize(std::min<Index>(model.body.shape_count(), parameters.betas.size()));
  kept.expression.conservativeResize(
      std::min<Index>(model.body.expression_count, parameters.expression.size()));
  kept.dmpl.conservativeResize(std::min<Index>(model.body.dmpl_count, parameters.dmpl.size()));
  BodyState state = state_of(model.body, kept);
  const Index known = std::min<Index>(model.betas, state.betas.size());
  state.betas.conservativeResize(model.betas);
  state.betas.tail(model.betas - known).setZero();
  return state;
}

bool start_is_given(const Settings& settings) {
  return settings.init != InitMode::automatic || settings.keypoints;
}

BodyState initial_pose(const FitModel& model, const Settings& settings, const PoseTargets& seen,
                       const Vec3d& centroid, const Execution& execution) {
  switch (settings.init) {
    case InitMode::tpose:
      return rest_pose_at(model, centroid);
    case InitMode::file:
      return state_of(model, settings.start.value().parameters);
    case InitMode::keypoints: {
      const auto usable = std::count_if(seen.keypoints.begin(), seen.keypoints.end(),
                                        [](const Keypoint& k) { return k.position_m && k.confidence > 0; });
      const BodyState rest = rest_pose_at(model, centroid);
      if (usable < 3) return rest;
      // As published where the alignment is; any other may leave the body turned.
      std::optional<Vec3d> start;
      if (settings.align == AlignMode::pca) start = rest.translation;
      return paper_pose(model, seen.keypoints, start, execution);
    }
    case InitMode::automatic:
      break;
  }
  return fit_landmarks(model, seen.targets);
}

Mat3d rotation_of(const Mat4d& similarity) { return similarity.topLeftCorner<3, 3>() / scale_of(similarity); }

UnitCandidate unit_of(const Mat4d& body_from_scan, double extent) {
  const double metres = scale_of(body_from_scan);
  UnitCandidate candidate{"", metres, extent * metres, 1.0};
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch}) {
    if (std::abs(metres / metres_per_unit(unit) - 1) < 1e-3) candidate.unit = to_string(unit);
  }
  return candidate;
}

}  // namespace vitruvian
