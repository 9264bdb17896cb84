#pragma once

#include <span>
#include <string_view>

namespace vitruvian {

/// How a dimension is taken.
enum class DimensionKind {
  stature,          ///< top of the body above the floor
  height,           ///< landmark a (or the mean of a and b) above the floor
  distance,         ///< straight line from a to b
  distance_middle,  ///< straight line from the middle of a and c to b
  path,             ///< straight lines a - b - c
  vertical,         ///< height of a above b
  level_girth,      ///< horizontal tape at the height of a (or of the mean of a and b)
  level_breadth,    ///< left-right extent of that section
  level_depth,      ///< front-back extent of that section
  widest_girth,     ///< largest horizontal tape between the heights of a and b
  narrowest_girth,  ///< smallest one
  widest_breadth,   ///< largest left-right extent of a horizontal section between a and b
  limb_girth,       ///< tape across the segment's axis through a (or the mean of a and b)
  limb_widest,      ///< largest tape across the segment's axis between its fractions low and high
  limb_narrowest,   ///< smallest one
  tilted_girth,     ///< tape in the plane through a and b that is level from left to right
  sagittal_arc,     ///< taut tape over the surface from a to b in the median plane
  coronal_arc,      ///< taut tape from a over c to b in the plane of the three
  neck_base,        ///< taut tapes from a to b over c, left and right
  foot_extent,      ///< extent of the foot along the line from a to b, seen from above
};

/// What a tape may lie on.
enum class DimensionRegion { body_without_arms, torso, leg, arm };

/// One row of the table. Landmark names begin with '*' where the side's prefix belongs.
struct DimensionSpec {
  std::string_view id, name, standard, definition;
  bool paired;  ///< taken on the left and on the right
  DimensionKind kind;
  std::string_view a, b, c;
  DimensionRegion region;
  std::string_view segment;  ///< whose skin the tape lies on, '*' as above; empty: any
  double low, high;
};

std::span<const DimensionSpec> dimension_specs();

}  // namespace vitruvian
