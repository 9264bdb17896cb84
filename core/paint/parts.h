#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Segment of a scan vertex that lies near no part of the body.
constexpr std::uint8_t kNoSegment = 255;

/// Which of the 24 segments each vertex of a scan seems to belong to: that of the nearest vertex of a posed
/// body. Suggests regions to paint, and says where a flood ends.
/// @param scan  3 x N, body frame.  @param body  3 x V, body frame, posed; not empty.
/// @param segment  V, 0..23 (BodyModel::segment).  @param reach_m  farther vertices get kNoSegment, as do
/// those not finite.
std::vector<std::uint8_t> scan_segments(const Points3f& scan, const Points3f& body,
                                        std::span<const std::uint8_t> segment, float reach_m);

/// Vertices that can be reached from `start` along edges through vertices of the same label, ascending.
/// @throws Error(usage) when `start` is no vertex.
/// @param faces  3 x F.  @param label  of each vertex.
std::vector<int> flood(const Faces& faces, std::span<const std::uint8_t> label, int start);

}  // namespace vitruvian
