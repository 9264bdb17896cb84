#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Joint positions by name, one frame and unit for all.
using JointPositions = std::map<std::string, Vec3d>;

struct JointError {
  std::string joint;
  double error_mm;
};

/// How far registered joints lie from known ones.
struct JointErrors {
  std::vector<JointError> joints;  ///< those of the compared set that both sides know, in SMPL order
  double max_mm = 0;
  std::string worst;  ///< the joint that has max_mm
  double mean_mm = 0;
};

/// The paper's joint error: distance of each of the 22 SMPL joints after the pelvises were made to coincide;
/// `max_mm` is its e_max.
/// @param mm_per_unit  length of one unit of both position sets.
/// @throws Error(bad_file) when either side lacks the pelvis or they share no other joint.
JointErrors pelvis_aligned_errors(const JointPositions& registered, const JointPositions& truth,
                                  double mm_per_unit);

/// Distance of the 12 core joints (shoulders, elbows, wrists, hips, knees, ankles) after removing their mean
/// offset; for truths that come from another rig, whose joints sit elsewhere in the body. `max_mm` is the
/// core_max of contract.md.
/// @throws Error(bad_file) when the two sides share fewer than two core joints.
JointErrors core_joint_errors(const JointPositions& registered, const JointPositions& truth,
                              double mm_per_unit);

}  // namespace vitruvian
