#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// An orthographic camera round a body, in the body frame (metres).
/// Pixel (u, v), continuous, u to the right, v down, (0, 0) at the upper left corner of the image:
///   u = width / 2 + pixels_per_metre * right . (x - centre),  v = height / 2 - pixels_per_metre * up . (x -
///   centre).
struct Camera {
  Vec3f right, up, toward_viewer;  ///< orthonormal, right x up = toward_viewer
  Vec3f centre;                    ///< body frame, projects to the image's centre
  float pixels_per_metre;
  int width, height;

  Eigen::Vector2f project(const Vec3f& point) const {
    const Vec3f d = point - centre;
    return {width * 0.5f + pixels_per_metre * right.dot(d), height * 0.5f - pixels_per_metre * up.dot(d)};
  }
};

/// A shaded picture of the scan.
struct View {
  Camera camera;
  std::vector<std::uint8_t> rgb;  ///< height x width x 3
  std::vector<float> depth;  ///< height x width, along toward_viewer from the centre; -infinity where empty
  int left, top, right, bottom;  ///< silhouette's bounding box in pixels, right and bottom exclusive
};

/// One BlazePose landmark seen in one view.
struct ViewLandmark {
  Eigen::Vector2f pixel;  ///< continuous pixel coordinates of the view's image
  float visibility;       ///< 0..1
  float presence;         ///< 0..1
};

/// What the landmark network saw in one view: 33 landmarks, presence of a body, and the next region of
/// interest.
struct ViewLandmarks {
  std::vector<ViewLandmark> landmarks;  ///< 33
  float body_presence = 0;              ///< 0..1
};

/// A triangulated landmark in the frame of the cameras (body frame).
struct Landmark3d {
  Vec3f position;
  float confidence;  ///< 0..1; from visibility and agreement between views; 0 = unknown
  float residual;    ///< weighted rms distance to the rays, metres
};

constexpr int kLandmarkCount = 33;

}  // namespace vitruvian
