#include "anthropometry/measurements.h"

#include <cstdio>
#include <string>

#include "base/error.h"

namespace vitruvian {
namespace {

double fraction_of(const SectionRequest& request, double length) {
  const bool is_fraction = request.from == SectionRequest::From::fraction;
  const double t = is_fraction ? request.value : length > 0 ? request.value / length : -1;
  if (!(t >= 0 && t <= 1)) {
    char range[64];
    std::snprintf(range, sizeof range, "%.1f mm", 1e3 * length);
    throw Error(ErrorCode::usage, "the section of " +
                                      std::string(kSegmentNames[static_cast<std::size_t>(request.segment)]) +
                                      " lies beyond the segment: t goes from 0 to 1, d from 0 to " + range);
  }
  return request.from == SectionRequest::From::distal ? 1 - t : t;
}

SectionResult section(const Figure& figure, int segment, double t) {
  SectionResult result{segment, t, published_slab_area(figure, segment, t), std::nullopt};
  if (const std::optional<SectionLoop> loop = segment_section(figure, segment, t)) {
    result.measured = measure_segment_section(figure, segment, *loop);
  }
  return result;
}

}  // namespace

SectionResult section_at(const Figure& figure, const SectionRequest& request) {
  const double length = figure.axes[static_cast<std::size_t>(request.segment)].length();
  return section(figure, request.segment, fraction_of(request, length));
}

std::vector<SectionResult> section_profile(const Figure& figure, int segment, int count) {
  std::vector<SectionResult> profile;
  for (int i = 0; i < count; ++i) {
    profile.push_back(section(figure, segment, count > 1 ? static_cast<double>(i) / (count - 1) : 0));
  }
  return profile;
}

BodyMeasures measure_body(const Figure& figure) {
  BodyMeasures measures;
  measures.volume_m3 = body_volume(figure);
  measures.area_m2 = body_area(figure);
  for (int s = 0; s < kSegmentCount; ++s) {
    const auto i = static_cast<std::size_t>(s);
    measures.segments[i] = measure_segment(figure, s);
    measures.published[i] = published_segment_volume(figure, s);
    measures.mass_kg += measures.segments[i].mass_kg;
  }
  return measures;
}

}  // namespace vitruvian
