#pragma once

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "base/types.h"

namespace vitruvian::testing {

struct Solid {
  Points3f vertices;
  Faces faces;
};

/// Unit cube [0, 1]^3, faces counter-clockwise from outside.
inline Solid unit_cube() {
  Solid cube{Points3f(3, 8), Faces(3, 12)};
  for (int i = 0; i < 8; ++i) {
    cube.vertices.col(i) =
        Vec3f(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2 & 1));
  }
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int q = 0; q < 6; ++q) {
    cube.faces.col(2 * q) << quads[q][0], quads[q][1], quads[q][2];
    cube.faces.col(2 * q + 1) << quads[q][0], quads[q][2], quads[q][3];
  }
  return cube;
}

/// Closed surface over a grid of `rings` by `sectors`, `position(u, v)` with u, v in [0, 1) periodic.
template <typename Position>
Solid periodic_grid(int rings, int sectors, const Position& position) {
  Solid solid{Points3f(3, rings * sectors), Faces(3, 2 * rings * sectors)};
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const int i = r * sectors + s, right = r * sectors + (s + 1) % sectors,
                up = (r + 1) % rings * sectors + s, across = (r + 1) % rings * sectors + (s + 1) % sectors;
      solid.vertices.col(i) = position(static_cast<double>(r) / rings, static_cast<double>(s) / sectors);
      solid.faces.col(2 * i) << i, right, across;
      solid.faces.col(2 * i + 1) << i, across, up;
    }
  }
  return solid;
}

/// Torus round the Z axis: ring radius 1, tube radius `tube`.
inline Vec3f torus_point(double around, double tube_angle, double tube) {
  const double a = 2 * std::numbers::pi * around, b = 2 * std::numbers::pi * tube_angle;
  return Vec3d((1 + tube * std::cos(b)) * std::cos(a), (1 + tube * std::cos(b)) * std::sin(a),
               tube * std::sin(b))
      .cast<float>();
}

inline Solid torus(int rings, int sectors, double tube) {
  return periodic_grid(sectors, rings, [&](double v, double u) { return torus_point(u, v, tube); });
}

/// Sphere of radius 1 as a latitude-longitude mesh.
inline Solid sphere(int rings, int sectors) {
  const int inner = rings - 1;
  Solid solid{Points3f(3, 2 + inner * sectors), Faces(3, 2 * inner * sectors)};
  solid.vertices.col(0) = Vec3f::UnitZ();
  solid.vertices.col(1) = -Vec3f::UnitZ();
  const auto at = [&](int r, int s) { return 2 + r * sectors + s % sectors; };
  Index face = 0;
  for (int r = 0; r < inner; ++r) {
    const double polar = std::numbers::pi * (r + 1) / rings;
    for (int s = 0; s < sectors; ++s) {
      const double azimuth = 2 * std::numbers::pi * s / sectors;
      solid.vertices.col(at(r, s)) =
          Vec3d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar))
              .cast<float>();
      if (r == 0) solid.faces.col(face++) << 0, at(0, s), at(0, s + 1);
      if (r + 1 < inner) {
        solid.faces.col(face++) << at(r, s), at(r + 1, s), at(r + 1, s + 1);
        solid.faces.col(face++) << at(r, s), at(r + 1, s + 1), at(r, s + 1);
      } else {
        solid.faces.col(face++) << 1, at(r, s + 1), at(r, s);
      }
    }
  }
  return solid;
}

}  // namespace vitruvian::testing
