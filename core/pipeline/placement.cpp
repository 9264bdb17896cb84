#include "pipeline/placement.h"

#include <cmath>
#include <optional>

#include "align/frame.h"
#include "base/error.h"
#include "pipeline/given_keypoints.h"
#include "pipeline/start_state.h"

namespace vitruvian {
namespace {

constexpr std::size_t kLargestPlacements = 3;
/// Detection scores this near to the best are worth a look when the best one leads to a bad fit.
constexpr double kWorthTrying = 0.25;

std::optional<Vec3d> given_axis(Axis axis) {
  if (axis == Axis::automatic) return std::nullopt;
  return axis_vector(to_string(axis));
}

/// Whether up and front follow from the settings alone.
bool lies_as_given(const Settings& settings) {
  return settings.body_from_scan || (settings.up != Axis::automatic && settings.front != Axis::automatic);
}

}  // namespace

bool lies_by_keypoints(const Settings& settings) {
  return settings.keypoints && settings.keypoints->frame == KeypointFrame::scan &&
         settings.align != AlignMode::pca && !lies_as_given(settings);
}

bool looks_for_landmarks(const Settings& settings) {
  return !settings.keypoints &&
         (settings.init == InitMode::automatic || settings.init == InitMode::keypoints);
}

bool turns_by_sight(const Settings& settings) {
  return settings.front == Axis::automatic && settings.align != AlignMode::pca && !settings.body_from_scan &&
         !lies_by_keypoints(settings);
}

bool needs_pictures(const Settings& settings) {
  if (looks_for_landmarks(settings)) return true;
  return settings.align != AlignMode::pca && !lies_as_given(settings) && !lies_by_keypoints(settings);
}

Placement given_placement(const Settings& settings) {
  if (settings.body_from_scan) {
    return {rotation_of(*settings.body_from_scan), Vec3d::UnitY(), "given", settings.body_from_scan};
  }
  const std::optional<Vec3d> up = given_axis(settings.up), front = given_axis(settings.front);
  if (up && front) return {body_from_scan_rotation(*up, front), Vec3d::UnitY(), "given", std::nullopt};
  return {rotation_from_keypoints(settings.keypoints.value(), up, front), Vec3d::UnitY(), "keypoints",
          std::nullopt};
}

std::vector<Placement> list_placements(std::span<const UpHypothesis> ups, const Settings& settings) {
  if (settings.body_from_scan) {
    Placement placement = given_placement(settings);
    placement.trunk = placement.rotation * ups.front().up;
    return {placement};
  }
  const std::optional<Vec3d> front = given_axis(settings.front);
  if (settings.up != Axis::automatic) {
    // The body frame is as the user says; the pictures are taken upright along the trunk all the same.
    const Mat3d rotation = body_from_scan_rotation(axis_vector(to_string(settings.up)), front);
    return {{rotation, rotation * ups.front().up, "given", std::nullopt}};
  }
  std::vector<Placement> placements;
  for (const UpHypothesis& hypothesis : ups) {
    if (placements.size() >= kLargestPlacements) break;
    if (!placements.empty() && hypothesis.score < kWorthTrying * ups.front().score) break;
    if (front && std::abs(front->dot(hypothesis.up)) > 0.9) continue;
    placements.push_back(
        {body_from_scan_rotation(hypothesis.up, front), Vec3d::UnitY(), "views", std::nullopt});
  }
  if (placements.empty()) {
    throw Error(ErrorCode::usage,
                "--front lies along the body's up direction: give --up too, or another --front");
  }
  return placements;
}

}  // namespace vitruvian
