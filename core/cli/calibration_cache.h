#pragma once

#include <optional>
#include <string>
#include <vector>

#include "keypoints/landmark_calibration.h"

namespace vitruvian {

/// Folder of what can be made again: $XDG_CACHE_HOME/vitruvian, else $HOME/.cache/vitruvian. Empty, which
/// means no cache, when neither variable is set.
std::string cache_folder(const char* xdg_cache_home, const char* home);

/// Landmark calibrations of users' models, one file a model, keyed by the model's SHA-256.
class CalibrationCache {
 public:
  /// @param folder  need not exist; empty: nothing is kept.
  explicit CalibrationCache(std::string folder) : folder_(std::move(folder)) {}

  /// None when there is none, or it is damaged or of another version.
  std::optional<std::vector<LandmarkOffset>> find(const std::string& model_sha256) const;
  /// Written whole or not at all. A cache that cannot be written is no error.
  void keep(const std::string& model_sha256, const std::vector<LandmarkOffset>& landmarks) const;

  std::string path(const std::string& model_sha256) const;

 private:
  std::string folder_;
};

}  // namespace vitruvian
