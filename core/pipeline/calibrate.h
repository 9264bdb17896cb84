#pragma once

#include <functional>

#include "base/execution.h"
#include "keypoints/landmark_calibration.h"
#include "keypoints/network.h"
#include "pipeline/models.h"

namespace vitruvian {

/// Learns where the landmarks sit on a body model by looking at the model itself: random shapes in poses
/// drawn from the pose prior, seen and triangulated exactly like scans.
/// @param bodies  number of bodies; 24 or more are enough.
Calibration calibrate_model(const BodyModel& body, const PosePrior& prior, int bodies, std::uint32_t seed,
                            const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                            const Execution& execution);

}  // namespace vitruvian
