#include "keypoints/views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "geometry/ambient_occlusion.h"
#include "geometry/kdtree.h"
#include "geometry/rasteriser.h"

namespace vitruvian {
namespace {

/// Radii with which discs on the points close the surface: they reach the neighbours in most directions.
Eigen::VectorXf covering_radii(const Points3f& points, const Execution& execution) {
  constexpr int kNeighbours = 8;
  constexpr float kSmallest = 0.5f, kLargest = 3.0f;  // of the median
  Eigen::VectorXf radii = Eigen::VectorXf::Zero(points.cols());
  std::vector<int> finite;
  for (Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).allFinite()) finite.push_back(static_cast<int>(i));
  }
  if (finite.size() < 2) return radii;
  const KdTree tree(points, finite);
  execution.parallel_for(static_cast<std::ptrdiff_t>(finite.size()), 2000,
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           std::vector<Neighbour> neighbours;
                           for (std::ptrdiff_t k = begin; k < end; ++k) {
                             tree.nearest(points.col(finite[k]), kNeighbours + 1, neighbours);
                             radii[finite[k]] = std::sqrt(neighbours.back().squared_distance);
                           }
                         });
  std::vector<float> sorted;
  for (const int i : finite) sorted.push_back(radii[i]);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  for (const int i : finite) radii[i] = std::clamp(radii[i], kSmallest * *middle, kLargest * *middle);
  return radii;
}

/// Ends of a projected body along one axis. Points far beyond where all but a few in a thousand lie are
/// strays.
std::pair<float, float> robust_bounds(std::vector<float>& values) {
  constexpr double kTrimmed = 0.002;
  constexpr float kTolerated = 0.12f;
  if (values.empty()) return {-0.5f, 0.5f};
  const auto cut = static_cast<std::ptrdiff_t>(kTrimmed * static_cast<double>(values.size()));
  const auto low = values.begin() + cut, high = values.end() - 1 - cut;
  std::nth_element(values.begin(), low, values.end());
  if (low < high) std::nth_element(low + 1, high, values.end());
  const float slack = kTolerated * (*high - *low);
  return {std::max(*std::min_element(values.begin(), low + 1), *low - slack),
          std::min(*std::max_element(high, values.end()), *high + slack)};
}

std::pair<float, float> bounds_along(const Points3f& vertices, const Vec3f& axis) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(vertices.cols()));
  for (Index i = 0; i < vertices.cols(); ++i) {
    const float value = axis.dot(vertices.col(i));
    if (std::isfinite(value)) values.push_back(value);
  }
  return robust_bounds(values);
}

Camera looking(const Vec3f& toward_viewer, const Vec3f& up) {
  Camera camera;
  camera.toward_viewer = toward_viewer.normalized();
  camera.right = up.cross(camera.toward_viewer);
  camera.right =
      camera.right.norm() > 1e-6f ? Vec3f(camera.right.normalized()) : camera.toward_viewer.unitOrthogonal();
  camera.up = camera.toward_viewer.cross(camera.right);
  return camera;
}

/// Frames the given bounds along the camera's axes; depth is centred on the bounds too.
void frame(Camera& camera, std::pair<float, float> across, std::pair<float, float> upward,
           std::pair<float, float> toward, float extent, const Framing& framing) {
  camera.centre = 0.5f * (across.first + across.second) * camera.right +
                  0.5f * (upward.first + upward.second) * camera.up +
                  0.5f * (toward.first + toward.second) * camera.toward_viewer;
  camera.width = camera.height = framing.size;
  camera.pixels_per_metre = framing.fill * framing.size / std::max(extent, 1e-6f);
}

float span_of(std::pair<float, float> bounds) { return bounds.second - bounds.first; }

/// Brightness of a surface element, before its colour.
float brightness(const ViewStyle& style, const Vec3f& key, const Vec3f& normal_in_camera, float open_sky) {
  const float lit = style.key * std::max(0.0f, normal_in_camera.dot(key)) +
                    style.hemisphere * (0.5f + 0.5f * normal_in_camera.y()) + style.ambient;
  return lit * (style.occlusion_floor + (1 - style.occlusion_floor) * open_sky);
}

View render(const ViewSurface& surface, const Camera& camera, const ViewStyle& style) {
  Mat3f camera_from_surface;
  camera_from_surface << camera.right.transpose(), camera.up.transpose(), camera.toward_viewer.transpose();
  const float scale = camera.pixels_per_metre;
  const Vec3f flip(scale, -scale, scale), middle(0.5f * camera.width, 0.5f * camera.height, 0);
  Points3f screen = camera_from_surface * (surface.vertices.colwise() - camera.centre);
  screen = (flip.asDiagonal() * screen).colwise() + middle;

  Raster raster(camera.width, camera.height);
  const bool cloud = surface.faces.cols() == 0;
  if (cloud) {
    Points3f normals = camera_from_surface * surface.normals;
    normals.row(1) *= -1;
    draw_discs(raster, screen, surface.point_radii * scale, normals);
  } else {
    draw_triangles(raster, screen, surface.faces);
  }

  View view;
  view.camera = camera;
  view.rgb.assign(raster.depth.size() * 3, style.background);
  view.depth.assign(raster.depth.size(), -std::numeric_limits<float>::infinity());
  view.left = camera.width;
  view.top = camera.height;
  view.right = view.bottom = 0;
  const Vec3f key = style.key_direction.normalized();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const std::size_t pixel = raster.at(x, y);
      const Index source = raster.source[pixel];
      if (source < 0) continue;
      view.left = std::min(view.left, x);
      view.right = std::max(view.right, x + 1);
      view.top = std::min(view.top, y);
      view.bottom = std::max(view.bottom, y + 1);
      view.depth[pixel] = raster.depth[pixel] / scale;

      Vec3f normal;
      float open_sky;
      if (cloud) {
        normal = camera_from_surface * surface.normals.col(source);
        open_sky = surface.open_sky[source];
        if (normal.z() < 0) normal = -normal;
      } else {
        const int a = surface.faces(0, source), b = surface.faces(1, source), c = surface.faces(2, source);
        const float w1 = raster.weight1[pixel], w2 = raster.weight2[pixel], w0 = 1 - w1 - w2;
        normal = camera_from_surface *
                 (w0 * surface.normals.col(a) + w1 * surface.normals.col(b) + w2 * surface.normals.col(c));
        open_sky = w0 * surface.open_sky[a] + w1 * surface.open_sky[b] + w2 * surface.open_sky[c];
        // A smooth normal may lean a little away from the viewer at the rim; only a triangle seen from within
        // is turned.
        Vec3f flat = Vec3f(screen.col(b) - screen.col(a)).cross(Vec3f(screen.col(c) - screen.col(a)));
        flat.y() = -flat.y();
        if (flat.dot(normal) < 0) flat = -flat;
        if (flat.z() < 0 && normal.z() < 0) normal = -normal;
      }
      const float length = normal.norm();
      normal = length > 1e-6f ? Vec3f(normal / length) : Vec3f::UnitZ();
      const float bright = brightness(style, key, normal, open_sky);
      for (int k = 0; k < 3; ++k) {
        view.rgb[3 * pixel + k] =
            static_cast<std::uint8_t>(std::clamp(bright * style.skin[k] + 0.5f, 0.0f, 255.0f));
      }
    }
  }
  if (view.right == 0) view.left = view.top = 0;
  return view;
}

}  // namespace

ViewSurface prepare_surface(Points3f vertices, Faces faces, Points3f normals, const Execution& execution) {
  if (normals.cols() != 0 && normals.cols() != vertices.cols()) {
    throw Error(ErrorCode::internal, std::to_string(normals.cols()) + " normals for " +
                                         std::to_string(vertices.cols()) + " vertices");
  }
  if (faces.size() > 0 && (faces.minCoeff() < 0 || faces.maxCoeff() >= vertices.cols())) {
    throw Error(ErrorCode::internal, "a face refers to a vertex that does not exist");
  }
  ViewSurface surface;
  surface.vertices = std::move(vertices);
  surface.faces = std::move(faces);
  if (surface.faces.cols() == 0) surface.point_radii = covering_radii(surface.vertices, execution);
  if (normals.cols() == 0) normals = Points3f::Zero(3, surface.vertices.cols());
  const auto visibility = sky_visibility(surface.vertices, surface.faces, surface.point_radii, execution);
  surface.normals = outward_normals(surface.vertices, surface.faces, normals, visibility);
  surface.open_sky = ambient_occlusion(visibility, surface.normals);
  return surface;
}

Camera framing_camera(const Points3f& vertices, const Vec3f& toward_viewer, const Vec3f& up,
                      const Framing& framing) {
  Camera camera = looking(toward_viewer, up);
  const auto across = bounds_along(vertices, camera.right), upward = bounds_along(vertices, camera.up);
  frame(camera, across, upward, bounds_along(vertices, camera.toward_viewer),
        std::max(span_of(across), span_of(upward)), framing);
  return camera;
}

std::vector<Camera> ring_cameras(const Points3f& vertices, int count, const Framing& framing,
                                 const Vec3f& up) {
  const Eigen::Quaternionf tilt = Eigen::Quaternionf::FromTwoVectors(Vec3f::UnitY(), up);
  std::vector<Camera> cameras;
  for (int k = 0; k < count; ++k) {
    const double azimuth = 2 * std::numbers::pi * k / count;
    const Vec3f toward = Vec3d(std::sin(azimuth), 0, std::cos(azimuth)).cast<float>();
    cameras.push_back(framing_camera(vertices, tilt * toward, up, framing));
  }
  return cameras;
}

std::array<Camera, 2> paper_cameras(const Points3f& vertices, const Framing& framing) {
  const auto lateral = bounds_along(vertices, Vec3f::UnitX()),
             vertical = bounds_along(vertices, Vec3f::UnitY()),
             anterior = bounds_along(vertices, Vec3f::UnitZ());
  const float extent = std::max({span_of(lateral), span_of(vertical), span_of(anterior)});
  Camera front = looking(Vec3f::UnitZ(), Vec3f::UnitY()), side = looking(-Vec3f::UnitX(), Vec3f::UnitY());
  frame(front, lateral, vertical, anterior, extent, framing);
  frame(side, anterior, vertical, {-lateral.second, -lateral.first}, extent, framing);
  return {front, side};
}

std::vector<View> render_views(const ViewSurface& surface, std::span<const Camera> cameras,
                               const ViewStyle& style, const Execution& execution) {
  std::vector<View> views(cameras.size());
  execution.parallel_for(static_cast<std::ptrdiff_t>(cameras.size()), 1,
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           for (std::ptrdiff_t k = begin; k < end; ++k) {
                             execution.check();
                             views[k] = render(surface, cameras[k], style);
                           }
                         });
  return views;
}

}  // namespace vitruvian
