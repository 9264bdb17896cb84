#pragma once

#include <array>
#include <span>
#include <string_view>

#include "base/types.h"
#include "keypoints/view.h"

namespace vitruvian {

constexpr int kSmplKeypointCount = 22;

/// Where a joint comes from: copied from one landmark, computed from several, or unknown.
enum class JointSource { detected, derived, none };

struct SmplKeypoint {
  Vec3d position = Vec3d::Zero();  ///< frame of the landmarks; meaningless when source is none
  double confidence = 0;           ///< 0..1; 0 when source is none
  JointSource source = JointSource::none;
};

/// The free numbers of appendix A. Fractions run from the first-named point to the second; the defaults are
/// those of the default body in its rest pose, with the head taken at the middle of the ears.
struct SmplJointSettings {
  double head_back =
      0.1;  ///< shift of the head from the ears' middle, in units of eyes-to-ears (nose-to-ears)
  double neck_fraction = 0.28;                                 ///< shoulders' middle to head
  double pelvis_fraction = 0.16;                               ///< hips' middle to neck
  std::array<double, 3> spine_fractions{0.146, 0.321, 0.619};  ///< pelvis to neck: spine1, spine2, spine3
  double collar_fraction = 0.243;                              ///< neck to shoulder
  double collar_drop =
      0.125;  ///< shift of the collar from that line toward the pelvis, in units of neck-to-pelvis
  double derived_scale = 0.8;   ///< confidence of a derived joint, times the mean of its sources'
  double fallback_scale = 0.5;  ///< further factor where the preferred landmarks were missing
};

/// The 22 SMPL joints used for pose initialisation, from 33 BlazePose landmarks (appendix A, its table and
/// text). Landmarks of confidence 0 are unavailable. Head: ears shifted along eyes to ears; without both
/// eyes, along nose to ears; with one ear or none, the nose. A joint that lacks a source is `none`; a neck
/// without a head lies at the shoulders' middle.
/// @param landmarks  33, any frame.  @throws Error(internal) when there are not 33.
std::array<SmplKeypoint, kSmplKeypointCount> smpl_joints(std::span<const Landmark3d> landmarks,
                                                         const SmplJointSettings& settings);

}  // namespace vitruvian
