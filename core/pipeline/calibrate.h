#pragma once

#include <functional>

#include "base/execution.h"
#include "keypoints/landmark_calibration.h"
#include "keypoints/network.h"
#include "pipeline/models.h"

namespace vitruvian {

/// Learns where the landmarks sit on a body model by looking at the model itself: random shapes in poses
/// drawn from the pose prior, seen and triangulated exactly like scans.
/// @param prior   of the model's skeleton (prior_for_skeleton()).
/// @param bodies  number of bodies; 20 or more are enough.
/// @return offsets in SMPL's numbering of 24 joints, whatever the model's joints are.
Calibration calibrate_model(const BodyModel& body, const PosePrior& prior, int bodies, std::uint32_t seed,
                            const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                            const Execution& execution);

/// A calibration in SMPL's numbering as offsets from the model's own joints.
std::vector<LandmarkOffset> landmarks_on(const BodyModel& body, std::vector<LandmarkOffset> offsets);

}  // namespace vitruvian
