#include "editor/line_of_sight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vitruvian {
namespace {

constexpr double kThickest = 0.32;  // m
constexpr double kThinnest = 0.015;
/// Surfaces this near to each other are one, seen twice; points this near to the line are on it.
constexpr double kMerge = 0.012;

/// Distance at which a line of unit direction meets a triangle, from either side (Moeller and Trumbore).
std::optional<double> hit(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& origin,
                          const Vec3d& direction) {
  const Vec3d ab = b - a, ac = c - a, p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return std::nullopt;
  const Vec3d from_a = origin - a;
  const double u = from_a.dot(p) / determinant;
  if (u < 0 || u > 1) return std::nullopt;
  const Vec3d q = from_a.cross(ab);
  const double v = direction.dot(q) / determinant;
  if (v < 0 || u + v > 1) return std::nullopt;
  return ac.dot(q) / determinant;
}

std::vector<double> merged(std::vector<double> distances, double merge) {
  std::sort(distances.begin(), distances.end());
  std::vector<double> result;
  for (std::size_t i = 0; i < distances.size();) {
    std::size_t end = i + 1;
    while (end < distances.size() && distances[end] - distances[end - 1] <= merge) ++end;
    result.push_back((distances[i] + distances[end - 1]) / 2);
    i = end;
  }
  return result;
}

}  // namespace

std::vector<double> crossings(const Points3f& vertices, const Faces& faces, const LineOfSight& line,
                              double merge) {
  const Vec3d direction = line.direction.normalized();
  std::vector<double> distances;
  if (faces.cols() == 0) {
    for (Index i = 0; i < vertices.cols(); ++i) {
      const Vec3d from_origin = vertices.col(i).cast<double>() - line.origin;
      const double along = from_origin.dot(direction);
      if ((from_origin - along * direction).squaredNorm() <= merge * merge) distances.push_back(along);
    }
    return merged(std::move(distances), merge);
  }
  for (Index f = 0; f < faces.cols(); ++f) {
    const Vec3d a = vertices.col(faces(0, f)).cast<double>(), b = vertices.col(faces(1, f)).cast<double>(),
                c = vertices.col(faces(2, f)).cast<double>();
    if (const auto distance = hit(a, b, c, line.origin, direction)) distances.push_back(*distance);
  }
  return merged(std::move(distances), merge / 8);
}

std::optional<Vec3d> middle_of_body(const Points3f& vertices, const Faces& faces, const LineOfSight& line,
                                    double distance_now, double metres_per_unit) {
  const std::vector<double> through = crossings(vertices, faces, line, kMerge / metres_per_unit);
  std::optional<double> best;
  // Entries and exits take turns; a hole in the scan leaves one without its partner.
  if (through.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i + 1 < through.size(); i += 2) {
    const double thickness = (through[i + 1] - through[i]) * metres_per_unit;
    if (thickness < kThinnest || thickness > kThickest) continue;
    const double middle = (through[i] + through[i + 1]) / 2;
    if (!best || std::abs(middle - distance_now) < std::abs(*best - distance_now)) best = middle;
  }
  if (!best) return std::nullopt;
  return line.at(*best);
}

}  // namespace vitruvian
