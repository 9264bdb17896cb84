#pragma once

#include <string_view>
#include <vector>

#include "anthropometry/figure.h"

namespace vitruvian {

// The measures of the paper's appendix D, as published.

/// Half-thickness of the slab of D.2, for which the paper gives no number: the default body's rest pose has a
/// median edge of 16 mm, so this is the thinnest slab that holds about one ring of vertices. Metres.
constexpr double kSlabHalfThickness = 0.008;

struct PublishedVolume {
  double volume_m3 = 0;
  std::string_view reason;  ///< why it is 0, in plain words; else empty
};

/// D.1: volume of the unconstrained Delaunay tetrahedra of the segment's vertices. They fill exactly the
/// convex hull of the points, so this is the hull's volume, which is also the published fall-back. Degenerate
/// sets give 0.
PublishedVolume published_segment_volume(const Figure& figure, int segment);

/// D.2: convex hull area of the segment's vertices within the slab around c(t), projected onto its plane,
/// m^2. 0 when fewer than three vertices lie in the slab.
double published_slab_area(const Figure& figure, int segment, double t,
                           double half_thickness = kSlabHalfThickness);

/// D.3: distance between the segment's joints, metres.
inline double published_segment_length(const Figure& figure, int segment) {
  return figure.axes[static_cast<std::size_t>(segment)].length();
}

}  // namespace vitruvian
