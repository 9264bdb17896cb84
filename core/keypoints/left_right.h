#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/types.h"
#include "keypoints/view.h"

namespace vitruvian {

/// Rotation from the body frame (Y up, facing +Z, left on +X) to the paper's canonical frame (Z up, facing
/// +Y, left at smaller X); same origin.
Mat3d canonical_from_body_rotation();

/// The 16 left-right pairs of BlazePose landmarks, left first: eyes, ears, mouth corners, shoulders, elbows,
/// wrists, fingers, hips, knees, ankles, heels, foot indices.
extern const std::array<std::pair<int, int>, 16> kLandmarkPairs;

/// Outcome of the left-right consistency check (appendix B and its table).
enum class LeftRightFinding {
  consistent,   ///< shoulders and hips are ordered as expected, or the knees do not support the hips'
                ///< disagreement
  exchanged,    ///< the ordering contradicts the table: left and right must be exchanged
  unavailable,  ///< nose, a shoulder or a hip is unknown, or the nose gives no facing direction
};

/// Compares the lateral ordering of shoulders and hips with the one expected from facing direction (nose
/// against the middle of the shoulders) and uprightness (shoulders above hips or below). If only the hips
/// contradict, the knees decide. A landmark of confidence 0 counts as unavailable.
/// @param landmarks_canonical  33, canonical frame.
/// @throws Error(internal) when there are not 33.
LeftRightFinding check_left_right(std::span<const Landmark3d> landmarks_canonical);

/// Exchanges position, confidence and residual of every left-right pair, in any frame.
void exchange_left_right(std::vector<Landmark3d>& landmarks);

/// Runs the check on landmarks in the body frame and exchanges left and right if it says so.
LeftRightFinding correct_left_right(std::vector<Landmark3d>& landmarks_body);

}  // namespace vitruvian
