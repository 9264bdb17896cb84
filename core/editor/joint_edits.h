#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "pipeline/edits.h"

namespace vitruvian {

/// Joints that an edit changes; none: the joint is removed.
using JointChanges = std::map<std::string, std::optional<KeypointSet::Joint>>;

enum class BodySide { left, right };

/// Left becomes right and right becomes left.
/// @param locked  joints that stay as they are, and with them their partners.
JointChanges swapped_sides(const KeypointSet& keypoints, const std::set<std::string>& locked);

/// One side's limbs copied to the other, mirrored at the plane between the hips and shoulders (between those
/// pairs that are there). Hips, collars and shoulders stay: they define the plane.
/// @param from  the side that is copied.
/// @throws Error(usage) when neither both hips nor both shoulders are there.
JointChanges mirrored_limbs(const KeypointSet& keypoints, BodySide from, const std::set<std::string>& locked);

}  // namespace vitruvian
