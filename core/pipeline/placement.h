#pragma once

#include <optional>
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
  std::optional<Mat4d> body_from_scan;  ///< the whole transform, where it was given
};

/// Whether the way the scan lies follows from keypoints in its own frame.
bool lies_by_keypoints(const Settings& settings);
/// Whether landmarks are to be found in pictures; else keypoints or the start of the fit were given.
bool looks_for_landmarks(const Settings& settings);
/// Whether pictures are needed to tell where the body faces.
bool turns_by_sight(const Settings& settings);
/// Whether pictures are needed for any purpose but PCA's.
bool needs_pictures(const Settings& settings);

/// How the scan lies by what was given. Only when no pictures are needed and PCA is not asked for.
Placement given_placement(const Settings& settings);

/// Placements worth a look, the likeliest first; at least one.
/// @param ups  of UpDetector, best first.
/// @throws Error(usage) when the front that is set lies along every possible up.
std::vector<Placement> list_placements(std::span<const UpHypothesis> ups, const Settings& settings);

}  // namespace vitruvian
