#pragma once

#include "body/forward.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// A state as it is written: the linear coefficients told apart into shape, expression and soft tissue.
BodyParameters parameters_of(const BodyModel& body, const BodyState& state);

/// The state that parameters describe.
BodyState state_of(const BodyParameters& parameters);

}  // namespace vitruvian
