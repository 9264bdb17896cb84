#include "geometry/plane_section.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace vitruvian {
namespace {

/// A triangle that the plane crosses: entered through the edge that goes from above to below the plane, left
/// through the one that goes back up (both in the triangle's own direction of travel).
struct Crossing {
  int face;
  int enter_above, enter_below, leave_below, leave_above;
};

std::uint64_t edge_key(int above, int below) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(above)) << 32 |
         static_cast<std::uint32_t>(below);
}

class Section {
 public:
  Section(const Points3d& vertices, const Faces& faces, const Plane& plane)
      : vertices_(vertices), height_(plane.normal.transpose() * (vertices.colwise() - plane.point)) {
    for (Index f = 0; f < faces.cols(); ++f) cross(faces, f);
    used_.assign(crossings_.size(), 0);
  }

  std::vector<SectionLoop> loops() {
    std::vector<SectionLoop> result;
    // Curves that begin at a hole have to be walked from their beginning.
    std::unordered_map<std::uint64_t, int> left_by;
    for (const Crossing& c : crossings_) ++left_by[edge_key(c.leave_above, c.leave_below)];
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      const Crossing& c = crossings_[i];
      if (!used_[i] && left_by.find(edge_key(c.enter_above, c.enter_below)) == left_by.end()) walk(i, result);
    }
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      if (!used_[i]) walk(i, result);
    }
    return result;
  }

 private:
  void cross(const Faces& faces, Index f) {
    Crossing c{static_cast<int>(f), -1, -1, -1, -1};
    for (int k = 0; k < 3; ++k) {
      const int a = faces(k, f), b = faces((k + 1) % 3, f);
      const bool a_above = height_[a] >= 0, b_above = height_[b] >= 0;
      if (a_above && !b_above) c.enter_above = a, c.enter_below = b;
      if (!a_above && b_above) c.leave_below = a, c.leave_above = b;
    }
    if (c.enter_above < 0 || c.leave_above < 0) return;
    entered_by_.emplace(edge_key(c.enter_above, c.enter_below), crossings_.size());
    crossings_.push_back(c);
  }

  SectionPoint point(int above, int below) const {
    const double along = height_[above] / (height_[above] - height_[below]);
    return {above, below, along, (1 - along) * vertices_.col(above) + along * vertices_.col(below)};
  }

  void walk(std::size_t first, std::vector<SectionLoop>& result) {
    SectionLoop loop;
    std::size_t at = first;
    while (true) {
      const Crossing& c = crossings_[at];
      used_[at] = 1;
      loop.points.push_back(point(c.enter_above, c.enter_below));
      loop.face.push_back(c.face);
      const std::size_t next = unused_entered_by(edge_key(c.leave_above, c.leave_below));
      if (next < crossings_.size()) {
        at = next;
        continue;
      }
      const Crossing& begin = crossings_[first];
      loop.closed = c.leave_above == begin.enter_above && c.leave_below == begin.enter_below;
      if (!loop.closed) loop.points.push_back(point(c.leave_above, c.leave_below));
      break;
    }
    result.push_back(std::move(loop));
  }

  /// More than one triangle enters through an edge only where the mesh is no manifold; file order decides
  /// then.
  std::size_t unused_entered_by(std::uint64_t key) const {
    std::size_t best = crossings_.size();
    const auto [begin, end] = entered_by_.equal_range(key);
    for (auto i = begin; i != end; ++i) {
      if (!used_[i->second] && i->second < best) best = i->second;
    }
    return best;
  }

  const Points3d& vertices_;
  Eigen::RowVectorXd height_;
  std::vector<Crossing> crossings_;
  std::unordered_multimap<std::uint64_t, std::size_t> entered_by_;
  std::vector<char> used_;
};

}  // namespace

std::vector<SectionLoop> plane_section(const Points3d& vertices, const Faces& faces, const Plane& plane) {
  return Section(vertices, faces, plane).loops();
}

Points2d project_section(const SectionLoop& loop, const Vec3d& first_axis, const Vec3d& second_axis) {
  Points2d flat(2, static_cast<Index>(loop.points.size()));
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const Vec3d& p = loop.points[i].position;
    flat.col(static_cast<Index>(i)) << first_axis.dot(p), second_axis.dot(p);
  }
  return flat;
}

SectionMeasure measure_section(const SectionLoop& loop, const Vec3d& breadth_axis, const Vec3d& depth_axis) {
  SectionMeasure measure;
  const Points2d flat = project_section(loop, breadth_axis, depth_axis);
  if (flat.cols() == 0) return measure;
  measure.area = std::abs(polygon_area(flat));
  measure.perimeter = polygon_perimeter(flat);
  const std::vector<int> hull = convex_hull_2d(flat);
  const Points2d corners = flat(Eigen::all, hull);
  measure.hull_area = polygon_area(corners);
  measure.hull_perimeter = polygon_perimeter(corners);
  const Eigen::Vector2d extent = flat.rowwise().maxCoeff() - flat.rowwise().minCoeff();
  measure.breadth = extent[0];
  measure.depth = extent[1];
  return measure;
}

std::pair<Vec3d, Vec3d> plane_axes(const Vec3d& normal, const Vec3d& hint) {
  Vec3d first = hint - normal * normal.dot(hint);
  if (first.norm() < 1e-6 * (1 + hint.norm())) first = normal.unitOrthogonal();
  first.normalize();
  return {first, normal.cross(first)};
}

}  // namespace vitruvian
