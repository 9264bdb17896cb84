#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/types.h"
#include "paint/screen_selection.h"

namespace vitruvian {

/// A picture of a mesh: camera in perspective, and the picture's size in pixels. See ScreenSelection.
struct PaintCamera {
  Mat4d clip_from_mesh = Mat4d::Identity();
  int width = 0, height = 0;

  bool operator==(const PaintCamera&) const = default;
};

/// A mesh or point cloud that is painted on from one camera after another. What a camera sees is worked out
/// once, at its first stroke. Answers are vertices, ascending.
class PaintCanvas {
 public:
  /// @param vertices  3 x V, any frame.  @param faces  3 x F; none: a point cloud. Both must outlive the
  /// object.
  PaintCanvas(const Points3f& vertices, const Faces& faces) : vertices_(&vertices), faces_(&faces) {}

  /// Vertices seen within `radius` pixels of a way over the screen; one point: a dab. @throws Error(usage).
  std::vector<int> brush(const PaintCamera& camera, const std::vector<ScreenPoint>& way, double radius);
  /// Vertices seen inside a closed line. @throws Error(usage).
  std::vector<int> lasso(const PaintCamera& camera, const std::vector<ScreenPoint>& outline);
  /// The part that is pointed at: what is connected with the vertex seen nearest to `point` by vertices of
  /// the same label, seen or not; of a point cloud, all of that label. Nothing when none is within `reach`
  /// pixels.
  /// @param label  V.  @throws Error(usage).
  std::vector<int> part(const PaintCamera& camera, const ScreenPoint& point, double reach,
                        std::span<const std::uint8_t> label);

 private:
  const ScreenSelection& seen_by(const PaintCamera& camera);

  const Points3f* vertices_;
  const Faces* faces_;
  PaintCamera camera_;
  std::optional<ScreenSelection> seen_;
};

}  // namespace vitruvian
