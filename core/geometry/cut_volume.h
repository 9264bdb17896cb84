#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// A part of space that cuts points away: a box in any attitude, or the prism (or cone) behind a closed line
/// drawn on a picture.
struct CutVolume {
  enum class Shape { box, lasso };
  enum class Remove { inside, outside };

  Shape shape = Shape::box;
  Remove remove = Remove::inside;
  /// Box: affine, takes it to the cube from -1 to 1. Lasso: a camera's projective matrix that takes the scan
  /// to its picture (x, y after division by w; what has w <= 0 lies behind the camera and outside).
  Mat4d volume_from_scan = Mat4d::Identity();
  std::vector<Eigen::Vector2d> polygon;  ///< lasso: corners in the picture, at least 3; even-odd rule

  bool operator==(const CutVolume&) const = default;

  /// Whether a point of the scan frame lies inside; on a box's faces counts as inside.
  bool contains(const Vec3d& point) const;
};

/// 1 for each point that none of the volumes cuts away, else 0.
/// @param points  3 x N relative to `origin` in the scan frame.
std::vector<std::uint8_t> uncut_points(const std::vector<CutVolume>& volumes, const Points3f& points,
                                       const Vec3d& origin);

/// Faces whose three corners are all kept, with the numbers that the kept vertices have among themselves.
Faces uncut_faces(const Faces& faces, const std::vector<std::uint8_t>& kept);

}  // namespace vitruvian
