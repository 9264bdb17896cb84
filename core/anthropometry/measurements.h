#pragma once

#include <array>
#include <optional>
#include <vector>

#include "anthropometry/published.h"
#include "anthropometry/segment_measures.h"

namespace vitruvian {

/// Where along a segment a section is wanted.
struct SectionRequest {
  enum class From { fraction, proximal, distal };
  int segment = 0;
  From from = From::fraction;
  double value = 0;  ///< t in [0, 1], or metres from the proximal or distal joint
};

/// One section, as scanned.
struct SectionResult {
  int segment = 0;
  double t = 0;
  double published_area_m2 = 0;            ///< the paper's hull area of a slab
  std::optional<SectionMeasure> measured;  ///< the true section; none where the plane misses the segment
};

/// @throws Error(usage) when the place lies outside of the segment; the message says how long it is.
SectionResult section_at(const Figure& figure, const SectionRequest& request);

/// The paper's sweep: `count` sections at t = 0 ... 1.
std::vector<SectionResult> section_profile(const Figure& figure, int segment, int count);

/// What is measured of the 24 segments, as scanned.
struct BodyMeasures {
  double volume_m3 = 0;  ///< of the closed body
  double area_m2 = 0;
  double mass_kg = 0;  ///< sum of the segments', published densities
  std::array<SegmentMeasure, kSegmentCount> segments;
  std::array<PublishedVolume, kSegmentCount> published;
};
BodyMeasures measure_body(const Figure& figure);

}  // namespace vitruvian
