#include "geometry/cut_volume.h"

#include <algorithm>

namespace vitruvian {
namespace {

bool in_polygon(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

}  // namespace

bool CutVolume::contains(const Vec3d& point) const {
  const Eigen::Vector4d mapped = volume_from_scan.leftCols<3>() * point + volume_from_scan.col(3);
  if (shape == Shape::box) return mapped.head<3>().cwiseAbs().maxCoeff() <= 1;
  return mapped.w() > 0 && in_polygon(polygon, mapped.head<2>() / mapped.w());
}

std::vector<std::uint8_t> uncut_points(const std::vector<CutVolume>& volumes, const Points3f& points,
                                       const Vec3d& origin) {
  std::vector<std::uint8_t> kept(static_cast<std::size_t>(points.cols()), 1);
  for (Index i = 0; i < points.cols(); ++i) {
    const Vec3d point = origin + points.col(i).cast<double>();
    kept[static_cast<std::size_t>(i)] =
        std::none_of(volumes.begin(), volumes.end(), [&](const CutVolume& volume) {
          return volume.contains(point) == (volume.remove == CutVolume::Remove::inside);
        });
  }
  return kept;
}

Faces uncut_faces(const Faces& faces, const std::vector<std::uint8_t>& kept) {
  std::vector<int> number(kept.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) number[i] = count++;
  }
  Faces result(3, faces.cols());
  Index used = 0;
  for (Index f = 0; f < faces.cols(); ++f) {
    const auto corner = [&](int k) { return number[static_cast<std::size_t>(faces(k, f))]; };
    if (corner(0) < 0 || corner(1) < 0 || corner(2) < 0) continue;
    result.col(used++) << corner(0), corner(1), corner(2);
  }
  result.conservativeResize(3, used);
  return result;
}

}  // namespace vitruvian
