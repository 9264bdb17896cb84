#include "geometry/rasteriser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"

namespace vitruvian {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Barycentric slack that closes the seam between two triangles that share an edge.
constexpr float kSeam = 1e-5f;

std::size_t pixel_count(int width, int height) {
  constexpr int kLargestSide = 16384;
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide) {
    throw Error(ErrorCode::internal,
                "picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  return static_cast<std::size_t>(width) * height;
}

/// First pixel whose centre is not left of `coordinate`, in [0, size]; last one likewise, in [-1, size - 1].
int first_pixel(float coordinate, int size) {
  return static_cast<int>(std::ceil(std::clamp(coordinate - 0.5f, 0.0f, static_cast<float>(size))));
}
int last_pixel(float coordinate, int size) {
  return static_cast<int>(std::floor(std::clamp(coordinate - 0.5f, -1.0f, static_cast<float>(size - 1))));
}

/// Calls put(pixel, z, weight1, weight2, face) for each covered pixel.
template <class Put>
void scan_triangles(int width, int height, const Points3f& screen, const Faces& faces, const Put& put) {
  constexpr float kPad = 0.01f;  // pixels; wider than kSeam ever reaches for triangles that fit the picture
  for (Index f = 0; f < faces.cols(); ++f) {
    const float* a = screen.data() + 3 * static_cast<Index>(faces(0, f));
    const float* b = screen.data() + 3 * static_cast<Index>(faces(1, f));
    const float* c = screen.data() + 3 * static_cast<Index>(faces(2, f));
    const float abx = b[0] - a[0], aby = b[1] - a[1], acx = c[0] - a[0], acy = c[1] - a[1];
    const float abz = b[2] - a[2], acz = c[2] - a[2];
    const float area = abx * acy - aby * acx;
    // False for NaN too; an infinite corner makes the area infinite or NaN.
    if (!(std::fabs(area) > 1e-12f && std::fabs(area) < 1e30f && std::isfinite(a[2] + abz + acz))) continue;
    const int y0 = first_pixel(std::min({a[1], b[1], c[1]}) - kPad, height);
    const int y1 = last_pixel(std::max({a[1], b[1], c[1]}) + kPad, height);
    const int x0 = first_pixel(std::min({a[0], b[0], c[0]}) - kPad, width);
    const int x1 = last_pixel(std::max({a[0], b[0], c[0]}) + kPad, width);
    if (x0 > x1 || y0 > y1) continue;
    const float inverse = 1.0f / area;
    const float step1 = acy * inverse, step2 = -aby * inverse;
    for (int y = y0; y <= y1; ++y) {
      const float py = y + 0.5f - a[1], px0 = 0.5f - a[0];
      const float row1 = -py * acx * inverse, row2 = abx * py * inverse;
      const std::size_t row = static_cast<std::size_t>(y) * width;
      for (int x = x0; x <= x1; ++x) {
        const float px = x + px0;
        const float w1 = row1 + px * step1, w2 = row2 + px * step2;
        if (w1 < -kSeam || w2 < -kSeam || w1 + w2 > 1 + kSeam) continue;
        put(row + x, a[2] + w1 * abz + w2 * acz, w1, w2, static_cast<std::int32_t>(f));
      }
    }
  }
}

/// Calls put(pixel, z, point) for each pixel of each disc.
template <class Put>
void scan_discs(int width, int height, const Points3f& screen, const Eigen::VectorXf& radii,
                const Points3f& normals, const Put& put) {
  constexpr float kFlattest = 0.1f;  // |z| of a normal; discs seen edge-on stay a little open
  constexpr float kBulge = 0.5f;
  for (Index i = 0; i < screen.cols(); ++i) {
    const float x = screen(0, i), y = screen(1, i), z = screen(2, i);
    if (!(std::isfinite(x) && std::isfinite(y) && std::isfinite(z))) continue;
    const std::int32_t point = static_cast<std::int32_t>(i);
    const float r = std::isfinite(radii[i]) ? std::max(radii[i], 0.0f) : 0.0f, r2 = r * r;
    if (x >= 0 && y >= 0 && x < width && y < height) {
      put(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x), z, point);
    }
    float slope_x = 0, slope_y = 0;
    if (normals.cols() > 0 && normals.col(i).squaredNorm() > 0.5f) {
      const float nz = std::copysign(std::max(std::fabs(normals(2, i)), kFlattest), normals(2, i));
      slope_x = -normals(0, i) / nz;
      slope_y = -normals(1, i) / nz;
    }
    const int y0 = first_pixel(y - r, height), y1 = last_pixel(y + r, height);
    const int x0 = first_pixel(x - r, width), x1 = last_pixel(x + r, width);
    for (int v = y0; v <= y1; ++v) {
      const float dy = v + 0.5f - y;
      for (int u = x0; u <= x1; ++u) {
        const float dx = u + 0.5f - x, dz = slope_x * dx + slope_y * dy;
        const float d2 = dx * dx + dy * dy + dz * dz;
        if (d2 <= r2) put(static_cast<std::size_t>(v) * width + u, z + dz - kBulge * d2 / r, point);
      }
    }
  }
}

}  // namespace

Raster::Raster(int width, int height)
    : width(width),
      height(height),
      depth(pixel_count(width, height), -kInfinity),
      source(depth.size(), -1),
      weight1(depth.size(), 0.0f),
      weight2(depth.size(), 0.0f) {}

DepthRange::DepthRange(int width, int height)
    : width(width),
      height(height),
      nearest(pixel_count(width, height), -kInfinity),
      farthest(nearest.size(), kInfinity) {}

void draw_triangles(Raster& raster, const Points3f& screen, const Faces& faces) {
  scan_triangles(raster.width, raster.height, screen, faces,
                 [&raster](std::size_t pixel, float z, float w1, float w2, std::int32_t face) {
                   if (z <= raster.depth[pixel]) return;
                   raster.depth[pixel] = z;
                   raster.source[pixel] = face;
                   raster.weight1[pixel] = w1;
                   raster.weight2[pixel] = w2;
                 });
}

void draw_discs(Raster& raster, const Points3f& screen, const Eigen::VectorXf& radii,
                const Points3f& normals) {
  scan_discs(raster.width, raster.height, screen, radii, normals,
             [&raster](std::size_t pixel, float z, std::int32_t point) {
               if (z <= raster.depth[pixel]) return;
               raster.depth[pixel] = z;
               raster.source[pixel] = point;
               raster.weight1[pixel] = raster.weight2[pixel] = 0;
             });
}

void draw_triangles(DepthRange& range, const Points3f& screen, const Faces& faces) {
  scan_triangles(range.width, range.height, screen, faces,
                 [&range](std::size_t pixel, float z, float, float, std::int32_t) {
                   range.nearest[pixel] = std::max(range.nearest[pixel], z);
                   range.farthest[pixel] = std::min(range.farthest[pixel], z);
                 });
}

void draw_discs(DepthRange& range, const Points3f& screen, const Eigen::VectorXf& radii) {
  // What bulges toward the viewer in front must not bulge away from the viewer behind: both keep to the
  // plane.
  scan_discs(range.width, range.height, screen, radii, Points3f(3, 0),
             [&](std::size_t pixel, float, std::int32_t point) {
               range.nearest[pixel] = std::max(range.nearest[pixel], screen(2, point));
               range.farthest[pixel] = std::min(range.farthest[pixel], screen(2, point));
             });
}

}  // namespace vitruvian
