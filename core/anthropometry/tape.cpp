#include "anthropometry/tape.h"

#include <algorithm>

namespace vitruvian {
namespace {

/// Corners of the taut band round a part of a curve: its hull, from the first point to the last.
std::vector<SectionPoint> taut(const std::vector<SectionPoint>& part, const Vec3d& first,
                               const Vec3d& second) {
  SectionLoop loop;
  loop.points = part;
  std::vector<int> hull = convex_hull_2d(project_section(loop, first, second));
  std::sort(hull.begin(), hull.end());
  // The ends are touched whether they are corners of the hull or not.
  if (hull.empty() || hull.front() != 0) hull.insert(hull.begin(), 0);
  const int last = static_cast<int>(part.size()) - 1;
  if (hull.back() != last) hull.push_back(last);
  std::vector<SectionPoint> corners;
  for (const int i : hull) corners.push_back(part[static_cast<std::size_t>(i)]);
  return corners;
}

double course_length(const std::vector<Vec3d>& course, bool closed) {
  double sum = 0;
  for (std::size_t i = 1; i < course.size(); ++i) sum += (course[i] - course[i - 1]).norm();
  return closed && course.size() > 1 ? sum + (course.front() - course.back()).norm() : sum;
}

std::size_t nearest(const std::vector<SectionPoint>& points, const Vec3d& target) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((points[i].position - target).norm() < (points[best].position - target).norm()) best = i;
  }
  return best;
}

}  // namespace

std::vector<Vec3d> Tape::course(const Figure& figure) const {
  std::vector<Vec3d> result;
  for (const SectionPoint& p : corners) {
    result.emplace_back((1 - p.along) * figure.nodes.col(p.from) + p.along * figure.nodes.col(p.to));
  }
  return result;
}

double Tape::length_on(const Figure& figure) const { return course_length(course(figure), closed); }

const SegmentPartition::ClosedSurface& TapeMeasure::surface(SegmentSet region) {
  const auto found = surfaces_.find(region);
  if (found != surfaces_.end()) return found->second;
  return surfaces_.emplace(region, figure_.model->partition().closed(region)).first->second;
}

std::optional<SectionLoop> TapeMeasure::best_curve(const Plane& plane, SegmentSet region, SegmentSet wanted) {
  const SegmentPartition::ClosedSurface& closed = surface(region);
  std::vector<SectionLoop> loops = plane_section(figure_.nodes, closed.faces, plane);
  SectionLoop* best = nullptr;
  double best_length = 0;
  for (SectionLoop& loop : loops) {
    double length = 0;
    for (std::size_t i = 0; i < loop.face.size(); ++i) {
      const int segment = closed.segment[static_cast<std::size_t>(loop.face[i])];
      if (segment < 0 || !(wanted >> segment & 1)) continue;
      length += (loop.points[(i + 1) % loop.points.size()].position - loop.points[i].position).norm();
    }
    if (length > best_length) best = &loop, best_length = length;
  }
  if (best == nullptr) return std::nullopt;
  return std::move(*best);
}

std::optional<Tape> TapeMeasure::girth(const Plane& plane, SegmentSet region, SegmentSet wanted,
                                       const Vec3d& left) {
  const std::optional<SectionLoop> loop = best_curve(plane, region, wanted);
  if (!loop) return std::nullopt;
  const auto [first, second] = plane_axes(plane.normal, left);
  Tape tape;
  tape.section = measure_section(*loop, first, second);
  tape.length = tape.section.hull_perimeter;
  for (const int i : convex_hull_2d(project_section(*loop, first, second))) {
    tape.corners.push_back(loop->points[static_cast<std::size_t>(i)]);
  }
  return tape;
}

std::optional<Tape> TapeMeasure::arc(const Plane& plane, SegmentSet region, SegmentSet wanted,
                                     const Vec3d& from, const Vec3d& to, const Vec3d& over) {
  const std::optional<SectionLoop> loop = best_curve(plane, region, wanted);
  if (!loop || !loop->closed) return std::nullopt;
  const auto [first, second] = plane_axes(plane.normal, Vec3d::UnitY());
  const std::vector<SectionPoint>& points = loop->points;
  const std::size_t count = points.size(), a = nearest(points, from), b = nearest(points, to);
  std::optional<Tape> best;
  double best_distance = 0;
  for (const int step : {1, -1}) {
    std::vector<SectionPoint> part;
    for (std::size_t i = a;; i = (i + count + static_cast<std::size_t>(step == 1 ? 1 : count - 1)) % count) {
      part.push_back(points[i]);
      if (i == b) break;
    }
    const double distance = (part[nearest(part, over)].position - over).norm();
    if (best && distance >= best_distance) continue;
    best_distance = distance;
    Tape tape;
    tape.closed = false;
    tape.corners = taut(part, first, second);
    tape.section = measure_section(*loop, first, second);
    best = std::move(tape);
  }
  best->length = best->length_on(figure_);
  return best;
}

}  // namespace vitruvian
