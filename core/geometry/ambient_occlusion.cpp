#include "geometry/ambient_occlusion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "geometry/rasteriser.h"

namespace vitruvian {
namespace {

constexpr int kAxes = kSkyDirections / 2;
constexpr int kMapSize = 256;
constexpr float kBiasPixels = 1.5f;
constexpr float kDiscBias = 1.5f;
/// Slope beyond which the depth test is not loosened further.
constexpr float kSteepest = 3.0f;

/// A ball that holds the surface: centre of its box and half the diagonal.
struct Ball {
  Vec3f centre = Vec3f::Zero();
  float radius = 1;
};

bool finite(const Points3f& points, Index i) {
  return std::isfinite(points(0, i)) && std::isfinite(points(1, i)) && std::isfinite(points(2, i));
}

Ball bounding_ball(const Points3f& vertices) {
  Eigen::AlignedBox3f box;
  for (Index i = 0; i < vertices.cols(); ++i) {
    if (finite(vertices, i)) box.extend(Vec3f(vertices.col(i)));
  }
  if (box.isEmpty()) return {};
  return {box.center(), std::max(0.5f * box.diagonal().norm(), 1e-12f)};
}

/// Unit normal lines (sign without meaning) from the faces alone; zero where there is none.
Points3f face_normals(const Points3f& vertices, const Faces& faces) {
  Points3f normals(3, faces.cols());
  for (Index f = 0; f < faces.cols(); ++f) {
    const Vec3f a = vertices.col(faces(0, f)), b = vertices.col(faces(1, f)), c = vertices.col(faces(2, f));
    const Vec3f n = (b - a).cross(c - a);
    normals.col(f) = n.allFinite() ? n : Vec3f::Zero();
  }
  return normals;
}

/// Mean direction of the sky that each vertex sees; its length (0..0.5 or so) says how clear it is.
Points3f mean_sky(const std::vector<std::uint64_t>& visibility) {
  const Points3f sky = sky_directions();
  Points3f mean = Points3f::Zero(3, static_cast<Index>(visibility.size()));
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    int count = 0;
    for (int k = 0; k < kSkyDirections; ++k) {
      if (visibility[i] >> k & 1) {
        mean.col(static_cast<Index>(i)) += sky.col(k);
        ++count;
      }
    }
    if (count > 0) mean.col(static_cast<Index>(i)) /= static_cast<float>(count);
  }
  return mean;
}

/// Signs (+1, -1) that turn normals outward, from `clarity` = cosine-like agreement with the sky, weighted by
/// `weight`.
std::vector<float> outward_signs(const std::vector<float>& clarity, const std::vector<float>& weight) {
  constexpr float kClear = 0.12f;
  constexpr double kConsistent = 0.9;
  double outward = 0, inward = 0;
  for (std::size_t i = 0; i < clarity.size(); ++i) {
    if (clarity[i] > kClear) outward += weight[i];
    if (clarity[i] < -kClear) inward += weight[i];
  }
  const float majority = inward > outward ? -1.0f : 1.0f;
  std::vector<float> signs(clarity.size(), majority);
  if (std::max(outward, inward) < kConsistent * (outward + inward)) {
    for (std::size_t i = 0; i < clarity.size(); ++i) {
      if (std::fabs(clarity[i]) > kClear) signs[i] = clarity[i] > 0 ? 1.0f : -1.0f;
    }
  }
  return signs;
}

}  // namespace

Points3f sky_directions() {
  Points3f directions(3, kSkyDirections);
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int k = 0; k < kAxes; ++k) {
    const double z = (k + 0.5) / kAxes, r = std::sqrt(1.0 - z * z), angle = golden * k;
    directions.col(k) = Vec3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
    directions.col(k + kAxes) = -directions.col(k);
  }
  return directions;
}

std::vector<std::uint64_t> sky_visibility(const Points3f& vertices, const Faces& faces,
                                          const Eigen::VectorXf& point_radii, const Execution& execution) {
  const Index count = vertices.cols();
  std::vector<std::uint64_t> visibility(static_cast<std::size_t>(count), 0);
  const Ball ball = bounding_ball(vertices);
  const Points3f sky = sky_directions();
  const float pixels_per_unit = 0.5f * (kMapSize - 4) / ball.radius;

  const Eigen::VectorXf radii = pixels_per_unit * point_radii;
  Points3f line = Points3f::Zero(3, count);
  if (faces.cols() > 0) {
    const Points3f normals = face_normals(vertices, faces);
    for (Index f = 0; f < faces.cols(); ++f) {
      for (int k = 0; k < 3; ++k) {
        // Neighbouring faces may be wound differently: add lines, not arrows.
        auto sum = line.col(faces(k, f));
        sum += sum.dot(normals.col(f)) < 0 ? Vec3f(-normals.col(f)) : Vec3f(normals.col(f));
      }
    }
    for (Index i = 0; i < count; ++i) {
      const float length = line.col(i).norm();
      if (length > 0) line.col(i) /= length;
    }
  }

  std::mutex merging;
  execution.parallel_for(kAxes, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<std::uint64_t> seen(static_cast<std::size_t>(count), 0);
    Points3f screen(3, count);
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      execution.check();
      const Vec3f toward = sky.col(k);
      const Vec3f right = toward.unitOrthogonal(), up = toward.cross(right);
      Mat3f screen_from_scan;
      screen_from_scan << right.transpose(), -up.transpose(), toward.transpose();
      screen_from_scan *= pixels_per_unit;
      const Vec3f offset = Vec3f(0.5f * kMapSize, 0.5f * kMapSize, 0) - screen_from_scan * ball.centre;
      screen = (screen_from_scan * vertices).colwise() + offset;
      DepthRange range(kMapSize, kMapSize);
      if (faces.cols() > 0) {
        draw_triangles(range, screen, faces);
      } else {
        draw_discs(range, screen, radii);
      }
      for (Index i = 0; i < count; ++i) {
        if (!finite(vertices, i)) continue;
        const int x = std::clamp(static_cast<int>(screen(0, i)), 0, kMapSize - 1);
        const int y = std::clamp(static_cast<int>(screen(1, i)), 0, kMapSize - 1);
        const std::size_t pixel = static_cast<std::size_t>(y) * kMapSize + x;
        const float cosine = std::fabs(line.col(i).dot(toward));
        const float slope = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / std::max(cosine, 0.1f);
        // A disc that faces the viewer stands out from a slanting surface by up to its radius times the
        // slope.
        const float bias = faces.cols() > 0 ? kBiasPixels * std::clamp(slope, 1.0f, kSteepest)
                                            : 2 * kBiasPixels + kDiscBias * radii[i];
        if (screen(2, i) >= range.nearest[pixel] - bias) seen[i] |= std::uint64_t{1} << k;
        if (screen(2, i) <= range.farthest[pixel] + bias) seen[i] |= std::uint64_t{1} << (k + kAxes);
      }
    }
    const std::lock_guard<std::mutex> lock(merging);
    for (std::size_t i = 0; i < seen.size(); ++i) visibility[i] |= seen[i];
  });
  return visibility;
}

Eigen::VectorXf ambient_occlusion(const std::vector<std::uint64_t>& visibility, const Points3f& normals) {
  const Points3f sky = sky_directions();
  Eigen::VectorXf open(static_cast<Index>(visibility.size()));
  for (Index i = 0; i < open.size(); ++i) {
    const Vec3f normal = normals.col(i);
    const bool known = normal.squaredNorm() > 0;
    float seen = 0, all = 0;
    for (int k = 0; k < kSkyDirections; ++k) {
      const float weight = known ? std::max(0.0f, normal.dot(sky.col(k))) : 1.0f;
      all += weight;
      if (visibility[i] >> k & 1) seen += weight;
    }
    open[i] = all > 0 ? seen / all : 0;
  }
  return open;
}

Points3f outward_normals(const Points3f& vertices, const Faces& faces, const Points3f& normals,
                         const std::vector<std::uint64_t>& visibility) {
  const Points3f sky = mean_sky(visibility);
  Points3f result = Points3f::Zero(3, vertices.cols());
  if (faces.cols() > 0) {
    const Points3f area_normals = face_normals(vertices, faces);
    std::vector<float> clarity(faces.cols()), weight(faces.cols());
    for (Index f = 0; f < faces.cols(); ++f) {
      weight[f] = area_normals.col(f).norm();
      const Vec3f seen = sky.col(faces(0, f)) + sky.col(faces(1, f)) + sky.col(faces(2, f));
      clarity[f] = weight[f] > 0 ? seen.dot(area_normals.col(f)) / (3 * weight[f]) : 0;
    }
    const std::vector<float> signs = outward_signs(clarity, weight);
    for (Index f = 0; f < faces.cols(); ++f) {
      for (int k = 0; k < 3; ++k) result.col(faces(k, f)) += signs[f] * area_normals.col(f);
    }
  } else {
    std::vector<float> clarity(vertices.cols(), 0.0f), weight(vertices.cols(), 1.0f);
    for (Index i = 0; i < vertices.cols(); ++i) clarity[i] = sky.col(i).dot(normals.col(i));
    const std::vector<float> signs = outward_signs(clarity, weight);
    for (Index i = 0; i < vertices.cols(); ++i) {
      const Vec3f normal = normals.col(i);
      result.col(i) = normal.squaredNorm() > 0 ? Vec3f(signs[i] * normal) : Vec3f(sky.col(i));
    }
  }
  for (Index i = 0; i < result.cols(); ++i) {
    const float length = result.col(i).norm();
    if (length > 0 && std::isfinite(length)) {
      result.col(i) /= length;
    } else {
      result.col(i).setZero();
    }
  }
  return result;
}

}  // namespace vitruvian
