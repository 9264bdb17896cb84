#include "keypoints/smpl_joints.h"

#include <optional>
#include <string>
#include <utility>

#include "base/error.h"

namespace vitruvian {
namespace {

struct Source {
  Vec3d position;
  double confidence;
};
using MaybeSource = std::optional<Source>;

/// SMPL joint and the landmark it is copied from.
constexpr std::pair<int, int> kDirect[] = {{1, 23},  {2, 24},  {4, 25},  {5, 26},  {7, 27},
                                           {8, 28},  {10, 31}, {11, 32}, {16, 11}, {17, 12},
                                           {18, 13}, {19, 14}, {20, 15}, {21, 16}};
constexpr int kPelvis = 0, kSpine[] = {3, 6, 9}, kNeck = 12, kLeftCollar = 13, kRightCollar = 14, kHead = 15;
constexpr int kNose = 0, kLeftEye = 2, kRightEye = 5, kLeftEar = 7, kRightEar = 8;

MaybeSource middle(const MaybeSource& a, const MaybeSource& b) {
  if (!a || !b) return std::nullopt;
  return Source{0.5 * (a->position + b->position), 0.5 * (a->confidence + b->confidence)};
}

/// Head from the face's landmarks; `scale` receives the confidence factor.
MaybeSource head_from_face(const MaybeSource& nose, const MaybeSource& ears, const MaybeSource& eyes,
                           const SmplJointSettings& settings) {
  if (ears && (eyes || nose)) {
    const Source& front = eyes ? *eyes : *nose;
    const double scale = settings.derived_scale * (eyes ? 1.0 : settings.fallback_scale);
    return Source{ears->position + settings.head_back * (ears->position - front.position),
                  scale * 0.5 * (ears->confidence + front.confidence)};
  }
  if (nose)
    return Source{nose->position, settings.derived_scale * settings.fallback_scale * nose->confidence};
  return std::nullopt;
}

}  // namespace

std::array<SmplKeypoint, kSmplKeypointCount> smpl_joints(std::span<const Landmark3d> landmarks,
                                                         const SmplJointSettings& settings) {
  if (landmarks.size() != kLandmarkCount) {
    throw Error(ErrorCode::internal, std::to_string(landmarks.size()) + " landmarks, not 33");
  }
  const auto landmark = [&](int index) -> MaybeSource {
    const Landmark3d& found = landmarks[index];
    if (!(found.confidence > 0) || !found.position.allFinite()) return std::nullopt;
    return Source{found.position.cast<double>(), found.confidence};
  };
  std::array<SmplKeypoint, kSmplKeypointCount> joints;
  const auto set = [&](int joint, const Vec3d& position, double confidence, JointSource source) {
    joints[joint] = {position, confidence, source};
  };
  for (const auto& [joint, index] : kDirect) {
    if (const MaybeSource found = landmark(index)) {
      set(joint, found->position, found->confidence, JointSource::detected);
    }
  }

  const MaybeSource hips = middle(landmark(23), landmark(24)), shoulders = middle(landmark(11), landmark(12));
  const MaybeSource head = head_from_face(landmark(kNose), middle(landmark(kLeftEar), landmark(kRightEar)),
                                          middle(landmark(kLeftEye), landmark(kRightEye)), settings);
  if (head) set(kHead, head->position, head->confidence, JointSource::derived);

  MaybeSource neck;
  if (shoulders && head) {
    neck = Source{shoulders->position + settings.neck_fraction * (head->position - shoulders->position),
                  settings.derived_scale * 0.5 * (shoulders->confidence + head->confidence)};
  } else if (shoulders) {
    neck =
        Source{shoulders->position, settings.derived_scale * settings.fallback_scale * shoulders->confidence};
  }
  if (neck) set(kNeck, neck->position, neck->confidence, JointSource::derived);

  if (hips && neck) {
    const Vec3d pelvis = hips->position + settings.pelvis_fraction * (neck->position - hips->position);
    const double confidence = settings.derived_scale * 0.5 * (hips->confidence + neck->confidence);
    set(kPelvis, pelvis, settings.derived_scale * hips->confidence, JointSource::derived);
    for (int k = 0; k < 3; ++k) {
      set(kSpine[k], pelvis + settings.spine_fractions[k] * (neck->position - pelvis), confidence,
          JointSource::derived);
    }
  } else if (hips) {
    set(kPelvis, hips->position, settings.derived_scale * settings.fallback_scale * hips->confidence,
        JointSource::derived);
  }

  for (const auto& [collar, shoulder] : {std::pair{kLeftCollar, 11}, std::pair{kRightCollar, 12}}) {
    const MaybeSource side = landmark(shoulder);
    if (!neck || !side) continue;
    Vec3d position = neck->position + settings.collar_fraction * (side->position - neck->position);
    if (joints[kPelvis].source != JointSource::none) {
      position += settings.collar_drop * (joints[kPelvis].position - neck->position);
    }
    set(collar, position, settings.derived_scale * 0.5 * (neck->confidence + side->confidence),
        JointSource::derived);
  }
  return joints;
}

}  // namespace vitruvian
