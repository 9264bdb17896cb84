#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "body/model.h"

namespace vitruvian {

/// What tells the models of the SMPL family apart.
struct SmplFamily {
  std::string name;  ///< "smpl", "smplh", "smplx" or "star"
  int joints;
  int pose_columns;                           ///< of posedirs
  int first_left_finger, first_right_finger;  ///< -1 without fingers; 15 each
  int jaw;                                    ///< -1 without face; the eyes follow
};

/// The family with so many joints and columns of pose correctives; none when there is no such family.
std::optional<SmplFamily> smpl_family(std::size_t joints, std::size_t pose_columns);

/// Names of a family's joints: SMPL's first 22, then hands, or face and fingers.
std::vector<std::string> joint_names(const SmplFamily& family);

/// Segment (0..23, contract order) of a joint: the fingers belong to the hand indices, jaw and eyes to the
/// head.
int segment_of_joint(const SmplFamily& family, int joint);

/// Gender that the last part of a path, or else the folder before it, speaks of: "SMPLX_FEMALE.npz",
/// "basicModel_m_lbs_10_207_0_v1.0.0.pkl", "smplh/neutral/model.npz". None when neither does.
std::optional<Gender> gender_from_path(std::string_view path);

}  // namespace vitruvian
