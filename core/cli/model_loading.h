#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/execution.h"
#include "cli/calibration_cache.h"
#include "keypoints/network.h"
#include "pipeline/models.h"

namespace vitruvian {

/// Model files that a user names; empty: the bundled ones.
struct ModelFiles {
  std::string model;
  std::string dmpl;
  std::string prior;
  int betas = 0;  ///< 0: the default number
};

/// Reads a body model of any kind, with soft tissue when named.
/// @throws Error(usage, bad_model, bad_file, unsupported_format, cannot_read).
BodyModel load_body_model(const ModelFiles& files, const std::vector<std::string>& data_folders);

/// How a file of the user's is recorded in registration.json.
/// @throws Error(cannot_read).
FileInfo file_info(const std::string& path);

/// Everything that a registration needs besides networks. For a user's own model the landmarks are learnt by
/// looking at it with `run_network` (once; later runs find them in the cache).
/// @throws as load_body_model(), and Error(cancelled).
Models load_models(const ModelFiles& files, const std::vector<std::string>& data_folders,
                   const CalibrationCache& cache,
                   const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                   const Execution& execution);

}  // namespace vitruvian
