#pragma once

#include "body/model.h"
#include "pose/pose_prior.h"

namespace vitruvian {

/// A prior over SMPL's 23 joints made to fit a model's skeleton: mean, precision and limits get 3 (J - 1)
/// numbers, in the model's joint order. The 21 body joints keep what is known of them (the hands are
/// marginalised out). Fingers follow the model's own hand poses, a normal distribution over their principal
/// components (Romero et al. 2017) with little freedom besides; without these they stay nearly straight. Jaw
/// and eyes move a little. A model of 24 joints gets the prior as it is.
PosePrior prior_for_skeleton(const PosePrior& prior, const BodyModel& body);

}  // namespace vitruvian
