#include "geometry/rasteriser.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Points3f random_screen(Random& random, int count, int size) {
  Points3f screen(3, count);
  for (int i = 0; i < count; ++i) {
    screen.col(i) = Vec3d(random.uniform(-0.3 * size, 1.3 * size), random.uniform(-0.3 * size, 1.3 * size),
                          random.uniform(-10, 10))
                        .cast<float>();
  }
  return screen;
}

/// Depth at a pixel's centre if the triangle covers it with some margin; NaN if it misses it with some margin
/// or is too close to an edge to say.
double depth_by_definition(const Vec3d& a, const Vec3d& b, const Vec3d& c, double x, double y,
                           bool& near_edge) {
  const auto side = [&](const Vec3d& p, const Vec3d& q) {
    const double length = std::hypot(q.x() - p.x(), q.y() - p.y());
    return ((q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x())) / std::max(length, 1e-9);
  };
  const double s0 = side(a, b), s1 = side(b, c), s2 = side(c, a);
  const double least = std::min({std::fabs(s0), std::fabs(s1), std::fabs(s2)});
  const bool inside = (s0 > 0 && s1 > 0 && s2 > 0) || (s0 < 0 && s1 < 0 && s2 < 0);
  near_edge = near_edge || least < 1e-2;
  if (!inside) return std::nan("");
  const Vec3d n = (b - a).cross(c - a);
  return a.z() - (n.x() * (x - a.x()) + n.y() * (y - a.y())) / n.z();
}

TEST(Rasteriser, AgreesWithPointInTriangleTest) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const int width = 40, height = 30;
    const Points3f screen = random_screen(random, 12, 40);
    Faces faces(3, 8);
    for (Index f = 0; f < faces.cols(); ++f) {
      double area = 0;
      while (area < 5) {
        for (int k = 0; k < 3; ++k) faces(k, f) = static_cast<int>(random.below(12));
        const Vec3f a = screen.col(faces(0, f)), b = screen.col(faces(1, f)), c = screen.col(faces(2, f));
        area = std::fabs((b - a).cross(c - a).z());
      }
    }
    Raster raster(width, height);
    draw_triangles(raster, screen, faces);
    int compared = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double best = -kInfinity;
        bool unclear = false;
        for (Index f = 0; f < faces.cols(); ++f) {
          const Vec3d a = screen.col(faces(0, f)).cast<double>(), b = screen.col(faces(1, f)).cast<double>(),
                      c = screen.col(faces(2, f)).cast<double>();
          const double z = depth_by_definition(a, b, c, x + 0.5, y + 0.5, unclear);
          if (z > best) best = z;
        }
        if (unclear) continue;
        ++compared;
        const float found = raster.depth[raster.at(x, y)];
        if (best == -kInfinity) {
          EXPECT_EQ(found, -kInfinity);
          EXPECT_EQ(raster.source[raster.at(x, y)], -1);
        } else {
          EXPECT_NEAR(found, best, 1e-2) << x << " " << y;
        }
      }
    }
    EXPECT_GT(compared, width * height / 4);
  }
}

TEST(Rasteriser, WeightsRebuildThePixelCentre) {
  const Points3f screen = (Points3f(3, 3) << 2, 30, 10, 3, 8, 28, 0, 1, 2).finished();
  const Faces faces = (Faces(3, 1) << 0, 1, 2).finished();
  Raster raster(32, 32);
  draw_triangles(raster, screen, faces);
  int covered = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const std::size_t pixel = raster.at(x, y);
      if (raster.source[pixel] < 0) continue;
      ++covered;
      const float w1 = raster.weight1[pixel], w2 = raster.weight2[pixel];
      const Vec3f point = (1 - w1 - w2) * screen.col(0) + w1 * screen.col(1) + w2 * screen.col(2);
      EXPECT_NEAR(point.x(), x + 0.5f, 1e-3);
      EXPECT_NEAR(point.y(), y + 0.5f, 1e-3);
      EXPECT_NEAR(point.z(), raster.depth[pixel], 1e-4);
    }
  }
  EXPECT_NEAR(covered, 0.5 * std::fabs(28 * 25 - 5 * 8), 30);
}

TEST(Rasteriser, LeavesNoSeamBetweenNeighbours) {
  // A fan of thin triangles round an odd centre covers the whole picture.
  const int spokes = 97;
  Points3f screen(3, spokes + 1);
  screen.col(0) = Vec3f(15.3f, 16.7f, 0);
  Faces faces(3, spokes);
  for (int k = 0; k < spokes; ++k) {
    const double angle = 2 * std::numbers::pi * k / spokes;
    screen.col(k + 1) = Vec3d(16 + 60 * std::cos(angle), 16 + 60 * std::sin(angle), 1).cast<float>();
    faces.col(k) << 0, k + 1, (k + 1) % spokes + 1;
  }
  Raster raster(32, 32);
  draw_triangles(raster, screen, faces);
  for (const std::int32_t source : raster.source) EXPECT_GE(source, 0);
}

TEST(Rasteriser, EarlierOfEqualTrianglesStaysWhateverTheWinding) {
  const Points3f screen = (Points3f(3, 3) << 0, 20, 0, 0, 0, 20, 5, 5, 5).finished();
  const Faces faces = (Faces(3, 2) << 0, 0, 1, 2, 2, 1).finished();
  Raster raster(10, 10);
  draw_triangles(raster, screen, faces);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(raster.source[raster.at(k, k / 2)], 0);
}

TEST(Rasteriser, IgnoresNonFiniteAndHugeTriangles) {
  const float nan = std::nanf(""), huge = 3e38f;
  const Points3f screen =
      (Points3f(3, 6) << 1, 9, nan, huge, -huge, kInfinity, 1, 2, 9, huge, 5, 5, 0, 0, 0, 0, 0, 0).finished();
  Faces faces(3, 3);
  faces << 0, 0, 3, 1, 1, 4, 2, 5, 5;
  Raster raster(10, 10);
  DepthRange range(10, 10);
  draw_triangles(raster, screen, faces);
  draw_triangles(range, screen, faces);
  draw_discs(raster, Points3f(screen.rightCols(4)), Eigen::VectorXf::Constant(4, nan), Points3f(3, 0));
  for (const std::int32_t source : raster.source) EXPECT_EQ(source, -1);
  for (const float z : range.nearest) EXPECT_EQ(z, -kInfinity);
}

TEST(Rasteriser, DepthRangeHoldsNearestAndFarthest) {
  Random random(5);
  const Points3f screen = random_screen(random, 30, 24);
  Faces faces(3, 20);
  for (Index k = 0; k < faces.size(); ++k) faces.data()[k] = static_cast<int>(random.below(30));
  Points3f behind = screen;
  behind.row(2) *= -1;
  Raster front(24, 24), back(24, 24);
  DepthRange range(24, 24);
  draw_triangles(front, screen, faces);
  draw_triangles(back, behind, faces);
  draw_triangles(range, screen, faces);
  for (std::size_t pixel = 0; pixel < front.depth.size(); ++pixel) {
    EXPECT_EQ(range.nearest[pixel], front.depth[pixel]);
    EXPECT_EQ(range.farthest[pixel], -back.depth[pixel]);
  }
}

TEST(Rasteriser, DiscsAreRoundAndTheNearerCentreWins) {
  Points3f screen(3, 2);
  screen << 10, 14, 16, 16, 0, 0;
  Raster raster(32, 32);
  draw_discs(raster, screen, Eigen::VectorXf::Constant(2, 6), Points3f(3, 0));
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const float d0 = std::hypot(x + 0.5f - 10, y + 0.5f - 16),
                  d1 = std::hypot(x + 0.5f - 14, y + 0.5f - 16);
      const int expected = std::min(d0, d1) > 6 ? -1 : d0 <= d1 ? 0 : 1;
      EXPECT_EQ(raster.source[raster.at(x, y)], expected) << x << " " << y;
    }
  }
}

TEST(Rasteriser, DiscLiesAcrossItsNormal) {
  const Vec3f normal = Vec3f(0.8f, 0, -0.6f);
  Raster raster(64, 64);
  draw_discs(raster, Points3f(Vec3f(32, 32, 5)), Eigen::VectorXf::Constant(1, 20), Points3f(normal));
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float dx = x + 0.5f - 32, dy = y + 0.5f - 32, dz = dx * 0.8f / 0.6f;
      const float distance = std::sqrt(dx * dx + dy * dy + dz * dz);
      if (std::fabs(distance - 20) < 0.1f) continue;
      EXPECT_EQ(raster.source[raster.at(x, y)], distance < 20 ? 0 : -1);
      if (distance < 10) EXPECT_NEAR(raster.depth[raster.at(x, y)], 5 + dz, 2.6);
    }
  }
}

TEST(Rasteriser, TinyDiscStillShows) {
  Raster raster(8, 8);
  draw_discs(raster, Points3f(Vec3f(3.1f, 5.9f, 2)), Eigen::VectorXf::Zero(1), Points3f(3, 0));
  EXPECT_EQ(raster.source[raster.at(3, 5)], 0);
  EXPECT_EQ(std::count(raster.source.begin(), raster.source.end(), 0), 1);
}

TEST(Rasteriser, RefusesImpossibleSizes) {
  EXPECT_THROW(Raster(0, 5), Error);
  EXPECT_THROW(Raster(5, 100000), Error);
  EXPECT_THROW(DepthRange(-1, 5), Error);
}

}  // namespace
}  // namespace vitruvian
