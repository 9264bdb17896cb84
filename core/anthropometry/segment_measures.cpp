#include "anthropometry/segment_measures.h"

#include <algorithm>

#include "geometry/mass_properties.h"

namespace vitruvian {
namespace {

constexpr SegmentSet set_of(std::initializer_list<int> segments) {
  SegmentSet set = 0;
  for (const int s : segments) set |= 1u << s;
  return set;
}

constexpr std::array<SegmentSet, 5> kLimbs = {set_of({0, 3, 6, 9, 12, 13, 14, 15}), set_of({1, 4, 7, 10}),
                                              set_of({2, 5, 8, 11}), set_of({16, 18, 20, 22}),
                                              set_of({17, 19, 21, 23})};

// kg/m^3, contract order. Trunk 1030; collars: "shoulder mass" 1040; head and neck 1110; thigh 1050; leg
// 1090; foot 1100; upper arm 1070; forearm 1130; hand 1160.
constexpr std::array<double, kSegmentCount> kDensity = {1030, 1050, 1050, 1030, 1090, 1090, 1030, 1100,
                                                        1100, 1030, 1100, 1100, 1110, 1040, 1040, 1110,
                                                        1070, 1070, 1130, 1130, 1160, 1160, 1160, 1160};

/// Length of the part of a curve that lies on the segment's own skin.
double own_length(const SectionLoop& loop, const SegmentPartition::ClosedSurface& surface, int segment) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.face.size(); ++i) {
    if (surface.segment[static_cast<std::size_t>(loop.face[i])] != segment) continue;
    sum += (loop.points[(i + 1) % loop.points.size()].position - loop.points[i].position).norm();
  }
  return sum;
}

}  // namespace

SegmentSet limb_of(int segment) {
  for (const SegmentSet limb : kLimbs) {
    if (limb >> segment & 1) return limb;
  }
  return kAllSegments;
}

double segment_density(int segment) { return kDensity[static_cast<std::size_t>(segment)]; }

SegmentMeasure measure_segment(const Figure& figure, int segment) {
  const SegmentPartition& partition = figure.model->partition();
  const SegmentAxis& axis = figure.axes[static_cast<std::size_t>(segment)];
  const MassProperties solid = mass_properties(figure.nodes, partition.closed(1u << segment).faces);
  const double density = segment_density(segment);
  const Mat3d& turn = axis.body_from_segment;
  SegmentMeasure measure;
  measure.length_m = axis.length();
  measure.volume_m3 = solid.volume;
  measure.area_m2 = surface_area(figure.nodes, partition.skin(1u << segment));
  measure.mass_kg = density * solid.volume;
  measure.com_m = turn.transpose() * (solid.centroid - axis.proximal);
  measure.inertia_kgm2 = density * turn.transpose() * solid.inertia * turn;
  return measure;
}

double body_volume(const Figure& figure) {
  return mass_properties(figure.nodes, figure.model->partition().closed(kAllSegments).faces).volume;
}

double body_area(const Figure& figure) {
  return surface_area(figure.nodes, figure.model->partition().skin(kAllSegments));
}

std::optional<SectionLoop> segment_section(const Figure& figure, int segment, double t) {
  const SegmentAxis& axis = figure.axes[static_cast<std::size_t>(segment)];
  const SegmentPartition::ClosedSurface surface = figure.model->partition().closed(limb_of(segment));
  const Plane plane{axis.at(t), -axis.body_from_segment.col(1)};
  std::vector<SectionLoop> loops = plane_section(figure.nodes, surface.faces, plane);
  SectionLoop* best = nullptr;
  double best_length = 0;
  for (SectionLoop& loop : loops) {
    const double length = own_length(loop, surface, segment);
    if (length > best_length) best = &loop, best_length = length;
  }
  if (best == nullptr) return std::nullopt;
  return std::move(*best);
}

SectionMeasure measure_segment_section(const Figure& figure, int segment, const SectionLoop& loop) {
  const Mat3d& turn = figure.axes[static_cast<std::size_t>(segment)].body_from_segment;
  return measure_section(loop, turn.col(2), turn.col(0));
}

}  // namespace vitruvian
