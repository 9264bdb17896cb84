#pragma once

#include <vector>

#include "base/types.h"

namespace vitruvian {

/// A point of the screen in pixels, x to the right and y down from the upper left corner.
using ScreenPoint = Eigen::Vector2d;

/// What a brush or lasso on the screen picks of a mesh or point cloud: vertices that are seen in this view
/// and no others, so that nothing is painted through the body. Made once a view; strokes then cost as much as
/// their own size.
class ScreenSelection {
 public:
  /// @param vertices  3 x V, any frame.  @param faces  3 x F; none: a point cloud, whose points hide what
  /// lies some pixels' widths behind them.
  /// @param clip_from_mesh  camera in perspective: clip space as in OpenGL (x right, y up, z away within
  /// -w..w).
  /// @throws Error(usage) when the view has no area, is too large, or the matrix is not finite.
  ScreenSelection(const Points3f& vertices, const Faces& faces, const Mat4d& clip_from_mesh, int width,
                  int height);

  /// Vertices seen within `radius` pixels of the way from `from` to `to`, ascending.
  std::vector<int> brush(const ScreenPoint& from, const ScreenPoint& to, double radius) const;
  /// Vertices seen inside a closed outline (even-odd rule; fewer than three corners: none), ascending.
  std::vector<int> lasso(const std::vector<ScreenPoint>& outline) const;
  /// The vertex seen nearest to a point, the first of several; -1 when none is within `reach` pixels.
  int nearest(const ScreenPoint& point, double reach) const;
  /// All vertices seen, ascending.
  const std::vector<int>& seen() const { return seen_; }

 private:
  template <typename Inside>
  std::vector<int> choose(Inside inside) const;

  Eigen::Matrix<float, 2, Eigen::Dynamic> screen_;  ///< 2 x V, pixels; NaN out of sight
  std::vector<int> seen_;
};

}  // namespace vitruvian
