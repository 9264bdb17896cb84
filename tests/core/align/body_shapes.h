#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "base/types.h"

namespace vitruvian {

struct Shape {
  Points3f vertices;
  Faces faces;
};

/// A skittle, 1.7 long along Y, wide at the foot and narrow at the head, centre near the origin; closed mesh.
inline Shape skittle() {
  const int rings = 60, sectors = 40;
  Shape shape{Points3f(3, (rings + 1) * sectors), Faces(3, 2 * rings * sectors)};
  Index f = 0;
  for (int r = 0; r <= rings; ++r) {
    const double t = static_cast<double>(r) / rings;
    const double radius = std::sqrt(std::max(0.0, t * (1 - t))) * (0.9 - 0.75 * t) + 1e-4;
    for (int s = 0; s < sectors; ++s) {
      const double angle = 2 * std::numbers::pi * s / sectors;
      shape.vertices.col(r * sectors + s) =
          Vec3d(radius * std::cos(angle), 1.7 * (t - 0.5), radius * std::sin(angle)).cast<float>();
      if (r == rings) continue;
      const int a = r * sectors + s, b = r * sectors + (s + 1) % sectors;
      shape.faces.col(f++) << a, a + sectors, b + sectors;
      shape.faces.col(f++) << a, b + sectors, b;
    }
  }
  return shape;
}

/// Evenly scattered points on a stick figure with arms held out: Y up, facing +Z (feet point there), 1.75
/// high with the feet at y = 0.
inline Points3f scattered_figure(Random& random, int count) {
  struct Limb {
    Vec3d from, to;
    double radius;
  };
  const std::vector<Limb> limbs{
      {{0, 0.9, 0}, {0, 1.45, 0}, 0.14},         {{0, 1.55, 0.02}, {0, 1.66, 0.02}, 0.09},
      {{0.1, 0.08, 0}, {0.1, 0.9, 0}, 0.07},     {{-0.1, 0.08, 0}, {-0.1, 0.9, 0}, 0.07},
      {{0.15, 1.4, 0}, {0.75, 1.2, 0}, 0.045},   {{-0.15, 1.4, 0}, {-0.75, 1.2, 0}, 0.045},
      {{0.1, 0.04, 0}, {0.12, 0.04, 0.2}, 0.04}, {{-0.1, 0.04, 0}, {-0.12, 0.04, 0.2}, 0.04}};
  double area = 0;
  for (const Limb& limb : limbs) area += limb.radius * (limb.to - limb.from).norm();
  Points3f points(3, count);
  for (int i = 0; i < count; ++i) {
    double pick = random.uniform() * area;
    std::size_t k = 0;
    while (k + 1 < limbs.size() && pick > limbs[k].radius * (limbs[k].to - limbs[k].from).norm()) {
      pick -= limbs[k].radius * (limbs[k].to - limbs[k].from).norm();
      ++k;
    }
    const Vec3d axis = (limbs[k].to - limbs[k].from).normalized(), side = axis.unitOrthogonal();
    const double t = random.uniform(), angle = 2 * std::numbers::pi * random.uniform();
    points.col(i) = (limbs[k].from + t * (limbs[k].to - limbs[k].from) +
                     limbs[k].radius * (std::cos(angle) * side + std::sin(angle) * axis.cross(side)))
                        .cast<float>();
  }
  return points;
}

inline Mat3d random_rotation(Random& random) {
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized()
      .toRotationMatrix();
}

}  // namespace vitruvian
