#include "editor/joint_edits.h"

#include <array>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace vitruvian {
namespace {

constexpr std::array<std::string_view, 8> kPairs = {"hip",    "knee",     "ankle", "foot",
                                                    "collar", "shoulder", "elbow", "wrist"};
constexpr std::array<std::string_view, 5> kLimbs = {"knee", "ankle", "foot", "elbow", "wrist"};

std::string left_of(std::string_view name) { return "left_" + std::string(name); }
std::string right_of(std::string_view name) { return "right_" + std::string(name); }

std::optional<KeypointSet::Joint> joint_of(const KeypointSet& keypoints, const std::string& name) {
  const auto found = keypoints.joints.find(name);
  if (found == keypoints.joints.end()) return std::nullopt;
  return found->second;
}

struct Plane {
  Vec3d point, normal;
};

Plane plane_of_symmetry(const KeypointSet& keypoints) {
  Vec3d across = Vec3d::Zero(), middle = Vec3d::Zero();
  int pairs = 0;
  for (const char* name : {"hip", "shoulder"}) {
    const auto left = joint_of(keypoints, left_of(name)), right = joint_of(keypoints, right_of(name));
    if (!left || !right) continue;
    across += left->position - right->position;
    middle += (left->position + right->position) / 2;
    ++pairs;
  }
  if (pairs == 0 || !(across.norm() > 0)) {
    throw Error(ErrorCode::usage, "mirroring needs both hips or both shoulders: place them first");
  }
  return {middle / pairs, across.normalized()};
}

}  // namespace

JointChanges swapped_sides(const KeypointSet& keypoints, const std::set<std::string>& locked) {
  JointChanges changes;
  for (const std::string_view name : kPairs) {
    const std::string left = left_of(name), right = right_of(name);
    if (locked.count(left) > 0 || locked.count(right) > 0) continue;
    const auto at_left = joint_of(keypoints, left), at_right = joint_of(keypoints, right);
    if (!at_left && !at_right) continue;
    changes[left] = at_right;
    changes[right] = at_left;
  }
  return changes;
}

JointChanges mirrored_limbs(const KeypointSet& keypoints, BodySide from,
                            const std::set<std::string>& locked) {
  const Plane plane = plane_of_symmetry(keypoints);
  JointChanges changes;
  for (const std::string_view name : kLimbs) {
    std::string source = left_of(name), target = right_of(name);
    if (from == BodySide::right) std::swap(source, target);
    auto joint = joint_of(keypoints, source);
    if (!joint || locked.count(target) > 0) continue;
    joint->position -= 2 * plane.normal.dot(joint->position - plane.point) * plane.normal;
    changes[target] = joint;
  }
  return changes;
}

}  // namespace vitruvian
