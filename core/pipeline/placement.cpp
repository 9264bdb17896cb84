#include "pipeline/placement.h"

#include <cmath>
#include <optional>

#include "align/frame.h"
#include "base/error.h"

namespace vitruvian {
namespace {

constexpr std::size_t kLargestPlacements = 3;
/// Detection scores this near to the best are worth a look when the best one leads to a bad fit.
constexpr double kWorthTrying = 0.25;

}  // namespace

std::vector<Placement> list_placements(std::span<const UpHypothesis> ups, const Settings& settings) {
  std::optional<Vec3d> front;
  if (settings.front != Axis::automatic) front = axis_vector(to_string(settings.front));
  if (settings.up != Axis::automatic) {
    // The body frame is as the user says; the pictures are taken upright along the trunk all the same.
    const Mat3d rotation = body_from_scan_rotation(axis_vector(to_string(settings.up)), front);
    return {{rotation, rotation * ups.front().up, "given"}};
  }
  std::vector<Placement> placements;
  for (const UpHypothesis& hypothesis : ups) {
    if (placements.size() >= kLargestPlacements) break;
    if (!placements.empty() && hypothesis.score < kWorthTrying * ups.front().score) break;
    if (front && std::abs(front->dot(hypothesis.up)) > 0.9) continue;
    placements.push_back({body_from_scan_rotation(hypothesis.up, front), Vec3d::UnitY(), "views"});
  }
  if (placements.empty()) {
    throw Error(ErrorCode::usage,
                "--front lies along the body's up direction: give --up too, or another --front");
  }
  return placements;
}

}  // namespace vitruvian
