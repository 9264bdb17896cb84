#include "editor/pose_preview.h"

#include "body/jacobian.h"
#include "fit/landmark_fit.h"

namespace vitruvian {

PosePreview::PosePreview(const Models& models, Gender gender, int betas)
    : model_(models.body, models.prior, gender, betas),
      equations_(model_),
      state_(fit_landmarks(model_, {})) {}

void PosePreview::begin(std::span<const LandmarkTarget> targets) { state_ = fit_landmarks(model_, targets); }

void PosePreview::follow(std::span<const LandmarkTarget> targets, int iterations) {
  if (targets.empty()) return;
  const LandmarkFitSettings weights;
  PosedModel posed;
  posed.rest = model_.body.v_template;
  for (int i = 0; i < iterations; ++i) {
    posed.skeleton = pose_skeleton(model_.body, state_);
    const BodyJacobian<float> jacobian(model_.body, model_.groups, state_, posed.skeleton, posed.rest);
    equations_.clear();
    for (const LandmarkTarget& target : targets) {
      // What a hand puts somewhere is meant: no robust kernel as for seen landmarks.
      const double scale = 1 / (static_cast<double>(targets.size()) * weights.scale * weights.scale);
      equations_.add(jacobian, posed, target, scale);
    }
    equations_.add_pose_prior(state_, posed, weights.gaussian, weights.limits);
    equations_.add_shape_prior(state_, weights.shape);
    equations_.step(posed, 1e-3, 0.5, state_);
  }
}

double PosePreview::error(std::span<const LandmarkTarget> targets) const {
  return landmark_error(pose_skeleton(model_.body, state_), targets);
}

}  // namespace vitruvian
