#pragma once

#include <span>

#include "fit/fit_observer.h"
#include "fit/normal_equations.h"

namespace vitruvian {

/// Weights of the landmark fit (inverse kinematics of our own method); defaults as measured best.
struct LandmarkFitSettings {
  int iterations = 30;
  double scale = 0.03;     ///< m, robust scale at the end; four times that in the first half
  double gaussian = 0.05;  ///< pose prior; four times that in the first third
  double limits = 0.2;
  double shape = 0.05;
};

/// Inverse kinematics of our own method: the pose whose calibrated landmarks lie at their targets, under the
/// weak Gaussian prior, joint limits and the shape prior; all joints, betas and translation free. Starts from
/// the prior's mean pose, placed by the torso.
BodyState fit_landmarks(const FitModel& model, std::span<const LandmarkTarget> landmarks,
                        const LandmarkFitSettings& settings = {}, const FitObserver& each = {});

/// Turns and moves a body rigidly so that its torso landmarks (hips, shoulders, a little the head) meet their
/// targets (Kabsch).
void place_by_torso(const FitModel& model, std::span<const LandmarkTarget> landmarks, BodyState& state);

/// Weighted mean distance of the landmarks to their targets, m.
double landmark_error(const Skeleton& skeleton, std::span<const LandmarkTarget> landmarks);

}  // namespace vitruvian
