#include "keypoints/left_right.h"

#include <string>

#include "base/error.h"

namespace vitruvian {
namespace {

constexpr int kNose = 0, kLeftShoulder = 11, kRightShoulder = 12, kLeftHip = 23, kRightHip = 24,
              kLeftKnee = 25, kRightKnee = 26;

}  // namespace

const std::array<std::pair<int, int>, 16> kLandmarkPairs{{{1, 4},
                                                          {2, 5},
                                                          {3, 6},
                                                          {7, 8},
                                                          {9, 10},
                                                          {11, 12},
                                                          {13, 14},
                                                          {15, 16},
                                                          {17, 18},
                                                          {19, 20},
                                                          {21, 22},
                                                          {23, 24},
                                                          {25, 26},
                                                          {27, 28},
                                                          {29, 30},
                                                          {31, 32}}};

Mat3d canonical_from_body_rotation() {
  Mat3d rotation;
  rotation << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  return rotation;
}

LeftRightFinding check_left_right(std::span<const Landmark3d> landmarks) {
  if (landmarks.size() != kLandmarkCount) {
    throw Error(ErrorCode::internal, std::to_string(landmarks.size()) + " landmarks, not 33");
  }
  const auto known = [&](int landmark) {
    return landmarks[landmark].confidence > 0 && landmarks[landmark].position.allFinite();
  };
  for (const int required : {kNose, kLeftShoulder, kRightShoulder, kLeftHip, kRightHip}) {
    if (!known(required)) return LeftRightFinding::unavailable;
  }
  const auto at = [&](int landmark) -> const Vec3f& { return landmarks[landmark].position; };
  const Vec3f shoulders = 0.5f * (at(kLeftShoulder) + at(kRightShoulder)),
              hips = 0.5f * (at(kLeftHip) + at(kRightHip));
  const float facing = at(kNose).y() - shoulders.y();
  if (facing == 0) return LeftRightFinding::unavailable;
  const bool upright = shoulders.z() > hips.z();
  const float left_sign = (facing > 0) == upright ? -1.0f : 1.0f;

  const auto contradicts = [&](int left, int right) {
    return (at(left).x() - at(right).x()) * left_sign < 0;
  };
  if (contradicts(kLeftShoulder, kRightShoulder)) return LeftRightFinding::exchanged;
  if (contradicts(kLeftHip, kRightHip) && known(kLeftKnee) && known(kRightKnee) &&
      contradicts(kLeftKnee, kRightKnee)) {
    return LeftRightFinding::exchanged;
  }
  return LeftRightFinding::consistent;
}

void exchange_left_right(std::vector<Landmark3d>& landmarks) {
  for (const auto& [left, right] : kLandmarkPairs) std::swap(landmarks.at(left), landmarks.at(right));
}

LeftRightFinding correct_left_right(std::vector<Landmark3d>& landmarks_body) {
  const Mat3f canonical_from_body = canonical_from_body_rotation().cast<float>();
  std::vector<Landmark3d> canonical = landmarks_body;
  for (Landmark3d& landmark : canonical) landmark.position = canonical_from_body * landmark.position;
  const LeftRightFinding finding = check_left_right(canonical);
  if (finding == LeftRightFinding::exchanged) exchange_left_right(landmarks_body);
  return finding;
}

}  // namespace vitruvian
