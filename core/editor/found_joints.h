#pragma once

#include <vector>

#include "fit/fit_model.h"
#include "pipeline/given_keypoints.h"

namespace vitruvian {

/// The found joints as an editor shows them: where the model has them, so that a body posed by them meets the
/// scan. What is seen lies beside a joint (a landmark of the hip in front of it, the ears beside the head),
/// by the calibration of the model: that offset is taken off what was detected, on the body posed by all
/// landmarks; derived joints, which appendix A puts on straight lines between landmarks, are that body's own.
/// Joints placed by hand and unknown ones stay. @param seen  body frame.  @return body frame.
std::vector<Keypoint> joints_of_model(const FitModel& model, const PoseTargets& seen);

}  // namespace vitruvian
