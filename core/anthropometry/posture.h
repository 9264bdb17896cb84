#pragma once

#include "anthropometry/figure.h"

namespace vitruvian {

/// Half the distance of the ankles and the arms' angle from the vertical in the standard posture.
constexpr double kAnkleHalfDistance = 0.100;
constexpr double kArmAngle = 0.34906585;  // 20 degrees

/// A body of given shape standing as ISO 20685-1 wants scanned people to stand for girths: upright, facing
/// +Z, ankles 200 mm apart, feet flat and pointing ahead as in the model's rest pose, straight arms 20
/// degrees from the vertical. Root rotation and translation are none. A quarter of the arms' fall is done by
/// the collars, up to 15 degrees.
BodyState standard_posture(const MeasuredModel& model, const Eigen::VectorXd& betas);

/// The same body sitting as ISO 7250-1 wants: trunk upright as at rest, thighs level and forward, lower legs
/// vertical, feet flat, upper arms hanging, forearms level and forward.
BodyState seated_posture(const MeasuredModel& model, const Eigen::VectorXd& betas);

}  // namespace vitruvian
