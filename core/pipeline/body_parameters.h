#pragma once

#include "body/forward.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// A state as it is written: the linear coefficients told apart into shape, expression and soft tissue.
BodyParameters parameters_of(const BodyModel& body, const BodyState& state);

/// The state of a model that parameters describe; the model may have more shape components than they.
/// @throws Error(usage) when the model lacks joints, shape, expression or soft tissue that they have.
BodyState state_of(const BodyModel& body, const BodyParameters& parameters);

}  // namespace vitruvian
