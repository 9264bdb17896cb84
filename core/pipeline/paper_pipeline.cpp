#include "pipeline/paper_pipeline.h"

#include <string>

#include "keypoints/smpl_joints.h"
#include "measure/correspondence.h"
#include "pose/inverse_kinematics.h"

namespace vitruvian {
namespace {

/// Columns of one label; all when there are no labels.
std::vector<int> members(const std::vector<int>& labels, Index count, int label) {
  std::vector<int> result;
  for (Index i = 0; i < count; ++i) {
    if (labels.empty() || labels[static_cast<std::size_t>(i)] == label) result.push_back(static_cast<int>(i));
  }
  return result;
}

Points3f columns_of(const Points3f& points, const std::vector<int>& index) {
  Points3f result(3, static_cast<Index>(index.size()));
  for (Index i = 0; i < result.cols(); ++i) result.col(i) = points.col(index[static_cast<std::size_t>(i)]);
  return result;
}

/// Part of a stage's progress that iterations of the solver make up, and the curve of their energy.
struct Part {
  const char* stage;
  double begin, end;
  const char* curve;
};

/// Passes an iteration on as the fraction done of a stage, and its energy.
EnergyCallback each_of(const Execution& execution, const EnergyTrace& trace, const Part& part,
                       int iterations) {
  return [=, &execution, &trace](int iteration, double energy) {
    if (iteration % 10 == 0)
      execution.progress(part.stage, part.begin + (part.end - part.begin) * iteration / iterations);
    if (trace) trace(part.curve, iteration, energy);
  };
}

}  // namespace

BodyState paper_pose(const FitModel& model, const std::vector<Keypoint>& keypoints,
                     const std::optional<Vec3d>& start_translation, const Execution& execution) {
  Points3d targets = Points3d::Zero(3, kSmplKeypointCount);
  Eigen::VectorXd confidences = Eigen::VectorXd::Zero(kSmplKeypointCount);
  for (int j = 0; j < kSmplKeypointCount; ++j) {
    const Keypoint& keypoint = keypoints.at(static_cast<std::size_t>(j));
    if (!keypoint.position_m) continue;
    targets.col(j) = *keypoint.position_m;
    confidences[j] = keypoint.confidence;
  }
  InverseKinematicsOptions options;
  options.betas = model.betas;
  options.start_translation = start_translation;
  const InverseKinematicsResult found =
      solve_inverse_kinematics(model.body, model.prior.vae, targets, confidences, options, execution);
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(model.betas);
  betas.head(found.betas.size()) = found.betas;
  return BodyState::from_axis_angle(found.pose, betas, found.translation);
}

std::vector<int> rematch_regions(const Points3f& template_vertices, const Points3f& scan_points,
                                 const RegionLabels& regions, const Execution& execution) {
  if (regions.count == 1) {
    const KdTree tree(scan_points);
    return rematch(template_vertices, scan_points, tree, execution);
  }
  std::vector<int> matches(static_cast<std::size_t>(template_vertices.cols()), -1);
  for (int label = 0; label < regions.count; ++label) {
    const std::vector<int> vertices = members(regions.vertices, template_vertices.cols(), label);
    std::vector<int> points = members(regions.scan, scan_points.cols(), label);
    // Template left over without scan left over: the whole scan is all there is to match it with.
    if (points.empty()) points = members({}, scan_points.cols(), 0);
    if (vertices.empty()) continue;
    const Points3f part = columns_of(scan_points, points);
    const std::vector<int> found =
        rematch(columns_of(template_vertices, vertices), part, KdTree(part), execution);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      matches[static_cast<std::size_t>(vertices[i])] = points[static_cast<std::size_t>(found[i])];
  }
  return matches;
}

PaperFit paper_distance_fit(const FitModel& model, const Points3f& scan_points, const RegionLabels& regions,
                            const BodyState& start, const Settings& settings, const Execution& execution,
                            const EnergyTrace& trace) {
  const PaperSolverOptions solver{settings.iterations, settings.adam_iterations};
  ChamferFitOptions weights;
  weights.distance = {settings.one_directional, settings.chunk};
  const ChamferDistance distance(scan_points, regions, weights.distance);
  return fit_chamfer(model.body, model.betas, distance, start, weights, solver, execution,
                     each_of(execution, trace, {"fit", 0, 1, "distance"}, solver.iterations));
}

PaperRefinement paper_correspondence_fit(const FitModel& model, const Points3f& scan_points,
                                         const RegionLabels& regions, const BodyState& start,
                                         const Settings& settings, const Execution& execution,
                                         const EnergyTrace& trace) {
  const PaperSolverOptions solver{settings.iterations, settings.adam_iterations};
  PaperRefinement result;
  const auto pass = [&](const BodyState& from, const Part& part) {
    result.matches =
        rematch_regions(posed_vertices<float>(model.body, from), scan_points, regions, execution);
    return fit_correspondences(model.body, model.betas, scan_points, result.matches, from, solver, execution,
                               each_of(execution, trace, part, solver.iterations));
  };
  result.first_pass = pass(start, {"refine", 0, 0.5, "correspondence 1"});
  result.second_pass = pass(result.first_pass.state, {"refine", 0.5, 1, "correspondence 2"});
  return result;
}

}  // namespace vitruvian
