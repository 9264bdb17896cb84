#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/execution.h"
#include "base/types.h"
#include "keypoints/view.h"

namespace vitruvian {

/// A scan made ready for pictures: normals that point outward whatever the file's winding, and ambient
/// occlusion. Both follow the surface when it is turned, so one preparation serves any number of cameras.
struct ViewSurface {
  Points3f vertices;         ///< 3 x V, metres
  Points3f normals;          ///< 3 x V, unit, outward; zero where unknown
  Faces faces;               ///< 3 x F; empty for a bare cloud
  Eigen::VectorXf open_sky;  ///< V, 0 (buried) .. 1 (open)
  Eigen::VectorXf
      point_radii;  ///< V, metres; of the discs that stand for a bare cloud's points; empty with faces
};

/// Prepares at most about 100,000 vertices (decimate larger scans first).
/// @param normals  3 x V or empty; used for bare clouds only, any sign.
/// @throws Error(internal) when sizes do not match or a face's index is out of range.
ViewSurface prepare_surface(Points3f vertices, Faces faces, Points3f normals, const Execution& execution);

/// Light and colours, in the camera's frame (right, up, toward the viewer). The defaults are the style in
/// which the landmark network erred least on pictures without texture.
struct ViewStyle {
  Vec3f key_direction{-0.4f, 0.6f, 0.75f};
  float key = 0.55f;
  float hemisphere = 0.4f;
  float ambient = 0.15f;
  float occlusion_floor = 0.35f;  ///< brightness of what sees no sky at all
  std::array<std::uint8_t, 3> skin{230, 180, 140};
  std::uint8_t background = 190;
};

/// Size of the picture in pixels and the share of it that the body spans in its longer direction.
struct Framing {
  int size = 400;
  float fill = 0.8f;
};

/// Camera that looks at the surface from `toward_viewer` with `up` upward in the picture (made orthogonal to
/// toward_viewer), the projected body centred. Stray points beyond the body do not shrink it.
Camera framing_camera(const Points3f& vertices, const Vec3f& toward_viewer, const Vec3f& up,
                      const Framing& framing);

/// Cameras round a body in the body frame, at azimuths 0, 360/count, ... about `up`. With Y up, azimuth 0
/// sees the front (from +Z) and 90 degrees the left side (from +X). For bodies that bend, lie or hang, `up`
/// along the trunk (hips to shoulders) instead of against gravity makes the landmark network err far less.
std::vector<Camera> ring_cameras(const Points3f& vertices, int count, const Framing& framing,
                                 const Vec3f& up = Vec3f::UnitY());

/// The paper's two views (section 3.1.2) of a body in the body frame: front, then side. The side camera
/// stands at the canonical frame's +X, which is the body's right side. Both have the same scale and the same
/// vertical bounds.
std::array<Camera, 2> paper_cameras(const Points3f& vertices, const Framing& framing);

/// Shaded picture of the surface for each camera.
std::vector<View> render_views(const ViewSurface& surface, std::span<const Camera> cameras,
                               const ViewStyle& style, const Execution& execution);

}  // namespace vitruvian
