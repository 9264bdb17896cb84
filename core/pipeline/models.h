#pragma once

#include <optional>
#include <string>
#include <vector>

#include "body/model.h"
#include "keypoints/landmark_calibration.h"
#include "pose/pose_prior.h"

namespace vitruvian {

/// A file of the user's.
struct FileInfo {
  std::string file;  ///< name without folders
  std::string sha256;
};

/// Everything learnt that a registration needs, besides the networks.
struct Models {
  BodyModel body;
  PosePrior prior;
  std::vector<LandmarkOffset> landmarks;  ///< calibrated on `body`
  std::optional<FileInfo> dmpl;           ///< soft tissue that was added to `body`
  std::optional<FileInfo> users_prior;    ///< in place of the bundled one
};

}  // namespace vitruvian
