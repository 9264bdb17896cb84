#pragma once

#include <span>

#include "body/forward.h"
#include "fit/fit_model.h"
#include "fit/normal_equations.h"
#include "pipeline/models.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// The posed body while joints are being dragged: our own inverse kinematics (fit_landmarks), carried on a
/// few steps at a time from where it was.
class PosePreview {
 public:
  /// @param models  must outlive the object.
  PosePreview(const Models& models, Gender gender, int betas);
  PosePreview(const PosePreview&) = delete;
  PosePreview& operator=(const PosePreview&) = delete;

  /// Poses the body anew, from the prior's mean pose.
  void begin(std::span<const LandmarkTarget> targets);
  /// Takes it nearer to where the targets are now. Without targets it stays.
  /// @param targets  body frame, metres.
  void follow(std::span<const LandmarkTarget> targets, int iterations);

  const BodyState& state() const { return state_; }
  /// Weighted mean distance of the joints to their targets, m.
  double error(std::span<const LandmarkTarget> targets) const;

 private:
  FitModel model_;
  NormalEquations equations_;
  BodyState state_;
};

}  // namespace vitruvian
