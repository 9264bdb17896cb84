#pragma once

#include <vector>

#include "fit/surface_fit.h"

namespace vitruvian {

/// The four limbs in the order of PosePrior::limbs; SMPL joints, which are also their segments. Fingers
/// follow the tip.
struct LimbChain {
  int root, middle, end, tip;  ///< shoulder, elbow, wrist, hand; or hip, knee, ankle, foot
};
inline constexpr LimbChain kLimbs[4] = {{16, 18, 20, 22}, {17, 19, 21, 23}, {1, 4, 7, 10}, {2, 5, 8, 11}};

/// Poses one limb anew by every configuration of the prior's library while the rest of the body stays, and
/// returns the `count` best that differ by more than 0.5 rad at the root. Cost: mean distance of limb
/// vertices to the scan plus mean distance of the scan points that the rest of the body leaves unexplained to
/// the limb (both capped at 20 cm).
std::vector<BodyState> search_limb(const FitModel& model, const ScanTarget& scan, const BodyState& state,
                                   int limb, int count);

}  // namespace vitruvian
