#include "paint/screen_selection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "geometry/rasteriser.h"

namespace vitruvian {
namespace {

constexpr int kLargestSide = 16384;
/// A lone point hides what lies behind it within this many pixels ...
constexpr float kPointRadius = 1.5f;
/// ... if it lies this many pixels' widths farther: discs facing the viewer overlap on a surface that slopes.
constexpr float kPointDepth = 5;

/// Of a depth, relative.
constexpr float kRounding = 1e-4f;

/// Screen places with two depths.
struct Projection {
  Points3f
      screen;  ///< pixels, and the distance's inverse: linear on the screen, larger nearer; NaN out of sight
  Eigen::VectorXf distance;  ///< from the camera's plane
};

Projection project(const Points3f& vertices, const Mat4d& clip_from_mesh, int width, int height) {
  Projection result{Points3f(3, vertices.cols()), Eigen::VectorXf(vertices.cols())};
  for (Index i = 0; i < vertices.cols(); ++i) {
    const Eigen::Vector4d clip = clip_from_mesh * vertices.col(i).cast<double>().homogeneous();
    if (clip.w() > 0 && std::fabs(clip.z()) <= clip.w()) {
      const Vec3d ndc = clip.head<3>() / clip.w();
      result.screen.col(i) =
          Vec3d((ndc.x() + 1) / 2 * width, (1 - ndc.y()) / 2 * height, 1 / clip.w()).cast<float>();
    } else {
      result.screen.col(i).setConstant(std::numeric_limits<float>::quiet_NaN());
    }
    result.distance[i] = static_cast<float>(clip.w());
  }
  return result;
}

/// The farthest surface that is seen in the 3 x 3 pixels round a place; +infinity where nothing is drawn. The
/// neighbours make up for what a slope gains in depth between a vertex and its pixel's centre.
float farthest_seen(const DepthRange& picture, int x, int y) {
  float farthest = std::numeric_limits<float>::infinity();
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, picture.height - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, picture.width - 1); ++i) {
      const float depth = picture.nearest[static_cast<std::size_t>(j) * picture.width + i];
      if (std::isfinite(depth)) farthest = std::min(farthest, depth);
    }
  }
  return farthest;
}

double distance_to_segment(const ScreenPoint& p, const ScreenPoint& a, const ScreenPoint& b) {
  const ScreenPoint way = b - a;
  const double length2 = way.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * way).norm();
}

}  // namespace

ScreenSelection::ScreenSelection(const Points3f& vertices, const Faces& faces, const Mat4d& clip_from_mesh,
                                 int width, int height) {
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide) {
    throw Error(ErrorCode::usage, "painting: a view of " + std::to_string(width) + " x " +
                                      std::to_string(height) + " pixels cannot be painted in");
  }
  if (!clip_from_mesh.allFinite()) throw Error(ErrorCode::usage, "painting: the camera is not finite");
  const double towards = clip_from_mesh.row(3).head<3>().norm();
  if (!(towards > 0)) throw Error(ErrorCode::usage, "painting: the camera is not one in perspective");
  // Of a pixel, at a distance of one.
  const double pixel = 2 * towards / (clip_from_mesh.row(1).head<3>().norm() * height);

  Projection projection = project(vertices, clip_from_mesh, width, height);
  DepthRange picture(width, height);
  const bool is_cloud = faces.cols() == 0;
  if (is_cloud) {
    for (Index i = 0; i < vertices.cols(); ++i) {
      if (projection.screen.col(i).allFinite()) projection.screen(2, i) = -projection.distance[i];
    }
    draw_discs(picture, projection.screen, Eigen::VectorXf::Constant(vertices.cols(), kPointRadius));
  } else {
    draw_triangles(picture, projection.screen, faces);
  }
  screen_ = projection.screen.topRows<2>();
  for (Index i = 0; i < screen_.cols(); ++i) {
    const Vec3f p = projection.screen.col(i);
    if (!p.allFinite() || p.x() < 0 || p.y() < 0 || p.x() >= static_cast<float>(width) ||
        p.y() >= static_cast<float>(height)) {
      continue;
    }
    const float limit = farthest_seen(picture, static_cast<int>(p.x()), static_cast<int>(p.y()));
    const float slack =
        is_cloud ? kPointDepth * static_cast<float>(pixel) * projection.distance[i] : kRounding * p.z();
    if (std::isfinite(limit) && p.z() >= limit - slack) seen_.push_back(static_cast<int>(i));
  }
}

template <typename Inside>
std::vector<int> ScreenSelection::choose(Inside inside) const {
  std::vector<int> chosen;
  for (const int i : seen_) {
    if (inside(ScreenPoint(screen_(0, i), screen_(1, i)))) chosen.push_back(i);
  }
  return chosen;
}

std::vector<int> ScreenSelection::brush(const ScreenPoint& from, const ScreenPoint& to, double radius) const {
  return choose([&](const ScreenPoint& p) { return distance_to_segment(p, from, to) <= radius; });
}

std::vector<int> ScreenSelection::lasso(const std::vector<ScreenPoint>& outline) const {
  if (outline.size() < 3) return {};
  return choose([&](const ScreenPoint& p) {
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
      const ScreenPoint &a = outline[i], &b = outline[j];
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
        inside = !inside;
      }
    }
    return inside;
  });
}

int ScreenSelection::nearest(const ScreenPoint& point, double reach) const {
  int found = -1;
  double least = reach;
  for (const int i : seen_) {
    const double distance = (ScreenPoint(screen_(0, i), screen_(1, i)) - point).norm();
    if (found < 0 ? distance <= least : distance < least) {
      found = i;
      least = distance;
    }
  }
  return found;
}

}  // namespace vitruvian
