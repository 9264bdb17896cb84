#pragma once

#include <array>
#include <optional>

#include "anthropometry/figure.h"
#include "geometry/plane_section.h"

namespace vitruvian {

/// Whole limbs and trunk: what a section of one of their segments may run through. Trunk: hips to head with
/// the collars; arms and legs end at their caps.
SegmentSet limb_of(int segment);

/// kg/m^3 of a segment, from cadavers: Dempster 1955 as tabulated by Winter, Biomechanics and Motor Control
/// of Human Movement (4th ed. 2009), table 4.1; trunk segments all have its density of the whole trunk.
double segment_density(int segment);
/// kg/m^3 of a whole adult body with half-filled lungs, for the uniform variant (mean of the densities that
/// hydrostatic weighing finds, about 985 with lungs at functional residual capacity).
constexpr double kUniformDensity = 985;

/// One closed segment.
struct SegmentMeasure {
  double length_m = 0;   ///< between its joints
  double volume_m3 = 0;  ///< closed by caps
  double area_m2 = 0;    ///< of its skin, caps not counted
  double mass_kg = 0;    ///< with the published segment density
  Vec3d com_m =
      Vec3d::Zero();  ///< centre of mass in the segment's anatomical frame, origin at the proximal joint
  /// About the centre of mass, axes of the anatomical frame, published density. For a uniform density
  /// multiply mass and inertia by kUniformDensity / segment_density.
  Mat3d inertia_kgm2 = Mat3d::Zero();
};
SegmentMeasure measure_segment(const Figure& figure, int segment);

/// Volume of the whole body, holes of its mesh capped, m^3; the segments' volumes add up to it.
double body_volume(const Figure& figure);
double body_area(const Figure& figure);

/// A true section across a segment at t along its axis: the curve of the closed limb (see limb_of) in which
/// most of the segment's own skin lies. Empty when the plane misses the segment's skin.
std::optional<SectionLoop> segment_section(const Figure& figure, int segment, double t);
/// Breadth along the segment's z (left-right), depth along its x (front-back).
SectionMeasure measure_segment_section(const Figure& figure, int segment, const SectionLoop& loop);

}  // namespace vitruvian
