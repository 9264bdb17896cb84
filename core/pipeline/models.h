#pragma once

#include <vector>

#include "body/model.h"
#include "keypoints/landmark_calibration.h"
#include "pose/pose_prior.h"

namespace vitruvian {

/// Everything learnt that a registration needs, besides the networks.
struct Models {
  BodyModel body;
  PosePrior prior;
  std::vector<LandmarkOffset> landmarks;  ///< calibrated on `body`
};

}  // namespace vitruvian
