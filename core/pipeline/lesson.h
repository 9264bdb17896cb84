#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fit/fit_trace.h"
#include "pipeline/pipeline.h"

namespace vitruvian {

/// What is changed in the fit to see what it does.
struct LessonSettings {
  bool tpose = false;            ///< start in the rest pose on the scan's centroid, keypoints unused
  double keypoint_noise_m = 0;   ///< standard deviation of what is added to each landmark, a coordinate; 0..1
  bool one_directional = false;  ///< only template to scan
  double prior_weight = 1;       ///< factor on pose prior, joint limits and shape prior; 0..100
  int iterations = 36;           ///< surface fit stops after so many; 1..36
  std::uint32_t seed = 1;

  bool operator==(const LessonSettings&) const = default;
};

/// One start of our own fit, from the landmarks to the surface, recorded. It is what the registration does
/// without its search for misplaced limbs, its other starts and its refinement.
struct Lesson {
  std::vector<TraceStep> steps;   ///< landmark fit (stage -1), surface fit, and the fitted body at the end
  std::vector<float> residual_m;  ///< a template vertex: distance to the scan's tangent plane next to it
  std::vector<LandmarkTarget> targets;  ///< as used, noise included; body frame
};

/// Largest and mean distance between the joints that two lessons on one scan end with, m.
struct JointsApart {
  double largest_m = 0;
  double mean_m = 0;
};
/// @throws Error(internal) when the lessons are about different bodies.
JointsApart joints_apart(const Lesson& a, const Lesson& b);

/// Runs our own fit on the pipeline's scan as it is placed (align_finding()), with something changed.
/// @throws Error(usage) for settings out of range, Error(internal) before the pipeline has its keypoints.
Lesson run_lesson(const RegistrationPipeline& pipeline, const LessonSettings& settings,
                  const Execution& execution);

}  // namespace vitruvian
