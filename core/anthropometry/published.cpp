#include "anthropometry/published.h"

#include <cmath>

#include "geometry/convex_hull.h"
#include "geometry/plane_section.h"

namespace vitruvian {

PublishedVolume published_segment_volume(const Figure& figure, int segment) {
  const Points3d own = figure.vertices(Eigen::all, figure.model->vertices(segment));
  const ConvexHull hull = convex_hull(own);
  return {hull.volume, describe(hull.defect)};
}

double published_slab_area(const Figure& figure, int segment, double t, double half_thickness) {
  const SegmentAxis& axis = figure.axes[static_cast<std::size_t>(segment)];
  const Vec3d centre = axis.at(t);
  const Vec3d direction = -axis.body_from_segment.col(1);
  const auto [first, second] = plane_axes(direction, axis.body_from_segment.col(0));
  std::vector<Eigen::Vector2d> inside;
  for (const int v : figure.model->vertices(segment)) {
    const Vec3d from_centre = figure.vertices.col(v) - centre;
    if (std::abs(direction.dot(from_centre)) <= half_thickness) {
      inside.emplace_back(first.dot(from_centre), second.dot(from_centre));
    }
  }
  if (inside.size() < 3) return 0;
  Points2d flat(2, static_cast<Index>(inside.size()));
  for (std::size_t i = 0; i < inside.size(); ++i) flat.col(static_cast<Index>(i)) = inside[i];
  const std::vector<int> hull = convex_hull_2d(flat);
  return hull.size() < 3 ? 0 : std::abs(polygon_area(flat(Eigen::all, hull)));
}

}  // namespace vitruvian
