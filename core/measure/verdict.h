#pragma once

#include <string>
#include <vector>

namespace vitruvian {

enum class VerdictStatus { ok, doubtful, failed };
std::string to_string(VerdictStatus status);

/// Whether the registration can be trusted, and why not.
struct Verdict {
  VerdictStatus status = VerdictStatus::failed;
  double confidence = 0;             ///< 0..1
  std::vector<std::string> reasons;  ///< plain words, naming body parts
};

}  // namespace vitruvian
