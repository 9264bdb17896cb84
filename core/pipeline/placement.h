#pragma once

#include <span>
#include <string>
#include <vector>

#include "align/up_detector.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// One assumption of how the scan lies.
struct Placement {
  Mat3d rotation;  ///< upright_from_scan, any heading
  Vec3d trunk;     ///< upright frame: direction along which the pictures are upright
  std::string method;
};

/// Placements worth a look, the likeliest first; at least one.
/// @param ups  of UpDetector, best first.
/// @throws Error(usage) when the front that is set lies along every possible up.
std::vector<Placement> list_placements(std::span<const UpHypothesis> ups, const Settings& settings);

}  // namespace vitruvian
