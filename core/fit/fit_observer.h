#pragma once

#include <functional>
#include <span>

#include "fit/normal_equations.h"

namespace vitruvian {

/// One iteration of a fit as it is before its step: the body, and what pulls at it. References are good for
/// the call only.
struct FitIteration {
  int stage;     ///< of the schedule, from 0; -1 in the landmark fit
  double scale;  ///< m, robust scale: of the surface's terms, of the landmarks' in the landmark fit
  const BodyState& state;
  const Skeleton& skeleton;
  const Points3f* vertices;                  ///< posed, body frame; null in the landmark fit
  std::span<const Correspondence> of_model;  ///< model samples to the scan
  std::span<const Correspondence> of_scan;   ///< scan samples to the model
  std::span<const LandmarkTarget> landmarks;
  double landmark_scale;   ///< m, robust scale of the landmarks
  double landmark_weight;  ///< of the mean squared landmark distance in units of landmark_scale
  double gaussian;         ///< weights of the priors, as in NormalEquations
  double limits;
  double shape;
};

/// Called in every iteration; nothing is computed for it when it is empty.
using FitObserver = std::function<void(const FitIteration&)>;

}  // namespace vitruvian
