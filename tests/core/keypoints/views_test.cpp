#include "keypoints/views.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

struct Mesh {
  Points3f vertices;
  Faces faces;
};

/// Ellipsoid with the given half axes, counter-clockwise from outside.
Mesh ellipsoid(const Vec3f& half, const Vec3f& centre) {
  const int rings = 40, sectors = 80;
  Mesh mesh{Points3f(3, (rings + 1) * sectors), Faces(3, 2 * rings * sectors)};
  Index f = 0;
  for (int r = 0; r <= rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const double polar = std::numbers::pi * (r + 0.01) / (rings + 0.02),
                   angle = 2 * std::numbers::pi * s / sectors;
      const Vec3f unit =
          Vec3d(std::sin(polar) * std::cos(angle), std::cos(polar), -std::sin(polar) * std::sin(angle))
              .cast<float>();
      mesh.vertices.col(r * sectors + s) = centre + half.cwiseProduct(unit);
      if (r == rings) continue;
      const int a = r * sectors + s, b = r * sectors + (s + 1) % sectors;
      mesh.faces.col(f++) << a, a + sectors, b + sectors;
      mesh.faces.col(f++) << a, b + sectors, b;
    }
  }
  return mesh;
}

Mesh body_like() { return ellipsoid({0.3f, 0.85f, 0.15f}, {0.1f, 0.2f, -0.3f}); }

ViewSurface prepared(const Mesh& mesh) {
  return prepare_surface(mesh.vertices, mesh.faces, Points3f(3, 0), Execution(1));
}

double mean_brightness(const View& view) {
  double sum = 0, count = 0;
  for (std::size_t pixel = 0; pixel < view.depth.size(); ++pixel) {
    if (view.depth[pixel] == -std::numeric_limits<float>::infinity()) continue;
    sum += view.rgb[3 * pixel];
    count += 1;
  }
  return sum / count;
}

TEST(Cameras, AreOrthonormalAndCentreTheBody) {
  const Mesh mesh = body_like();
  for (const Camera& camera : ring_cameras(mesh.vertices, 8, Framing())) {
    EXPECT_LT((camera.right.cross(camera.up) - camera.toward_viewer).norm(), 1e-5);
    EXPECT_LT((camera.up - Vec3f::UnitY()).norm(), 1e-5);
    float low = 1e9f, high = -1e9f;
    for (Index i = 0; i < mesh.vertices.cols(); ++i) {
      const auto pixel = camera.project(mesh.vertices.col(i));
      low = std::min(low, pixel.y());
      high = std::max(high, pixel.y());
    }
    EXPECT_NEAR(low, 40, 1);
    EXPECT_NEAR(high, 360, 1);
  }
}

TEST(Cameras, AzimuthZeroSeesTheFrontAndNinetyTheLeftSide) {
  const auto cameras = ring_cameras(body_like().vertices, 4, Framing());
  EXPECT_LT((cameras[0].toward_viewer - Vec3f::UnitZ()).norm(), 1e-6);
  EXPECT_LT((cameras[1].toward_viewer - Vec3f::UnitX()).norm(), 1e-6);
  // Seen from the front, the body's left (+X) is on the picture's right.
  EXPECT_GT(cameras[0].project({1, 0, 0}).x(), cameras[0].project({0, 0, 0}).x());
}

TEST(Cameras, RingTurnsAboutAnyUp) {
  const Mesh mesh = body_like();
  for (const Vec3f& up : {Vec3f(0, -1, 0), Vec3f(1, 0, 0), Vec3f(0.36f, 0.48f, -0.8f)}) {
    const auto cameras = ring_cameras(mesh.vertices, 8, Framing(), up);
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      EXPECT_LT((cameras[k].up - up).norm(), 1e-5);
      EXPECT_NEAR(cameras[k].toward_viewer.dot(cameras[(k + 2) % 8].toward_viewer), 0, 1e-5);
      EXPECT_LT((cameras[k].right - cameras[(k + 2) % 8].toward_viewer).norm(), 1e-5);
    }
  }
}

TEST(Cameras, StrayPointsDoNotShrinkTheBody) {
  Mesh mesh = body_like();
  const float before = ring_cameras(mesh.vertices, 1, Framing())[0].pixels_per_metre;
  mesh.vertices.col(5) = Vec3f(40, -60, 30);
  mesh.vertices.col(900) = Vec3f(std::nanf(""), 0, 0);
  EXPECT_GT(ring_cameras(mesh.vertices, 1, Framing())[0].pixels_per_metre, 0.75f * before);
}

TEST(Cameras, PaperViewsShareScaleAndHeight) {
  const auto [front, side] = paper_cameras(body_like().vertices, Framing());
  EXPECT_EQ(front.pixels_per_metre, side.pixels_per_metre);
  EXPECT_NEAR(front.centre.y(), side.centre.y(), 1e-6);
  EXPECT_LT((front.toward_viewer - Vec3f::UnitZ()).norm(), 1e-6);
  EXPECT_LT((side.toward_viewer + Vec3f::UnitX()).norm(), 1e-6);
  // Seen from canonical +X, canonical +Y (the body's front) is on the right.
  EXPECT_LT((side.right - Vec3f::UnitZ()).norm(), 1e-6);
}

TEST(Views, SilhouetteAndDepthAreThoseOfTheEllipsoid) {
  const Mesh mesh = body_like();
  const ViewSurface surface = prepared(mesh);
  const auto cameras = ring_cameras(mesh.vertices, 8, Framing());
  const auto views = render_views(surface, cameras, ViewStyle(), Execution(2));
  ASSERT_EQ(views.size(), 8u);
  for (std::size_t k = 0; k < views.size(); ++k) {
    const View& view = views[k];
    EXPECT_EQ(view.top, 40);
    EXPECT_EQ(view.bottom, 360);
    const double azimuth = k * std::numbers::pi / 4;
    const double half =
        std::hypot(0.3 * std::cos(azimuth), 0.15 * std::sin(azimuth)) * view.camera.pixels_per_metre;
    EXPECT_NEAR(view.right - view.left, 2 * half, 2.5);
  }
  // The front of the ellipsoid at azimuth 0 lies 0.15 m before the centre.
  const View& front = views[0];
  EXPECT_NEAR(front.depth[200 * 400 + 200], 0.15f, 1e-3);
  EXPECT_EQ(front.depth[0], -std::numeric_limits<float>::infinity());
  EXPECT_EQ(front.rgb[0], 190);
}

TEST(Views, LightComesFromTheUpperLeft) {
  const Mesh ball = ellipsoid({1, 1, 1}, {0, 0, 0});
  const View view =
      render_views(prepared(ball), ring_cameras(ball.vertices, 1, Framing()), ViewStyle(), Execution(1))[0];
  const auto red = [&](int x, int y) { return static_cast<int>(view.rgb[3 * (y * 400 + x)]); };
  EXPECT_GT(red(130, 120), red(270, 280) + 30);
  EXPECT_GT(red(200, 120), red(200, 280));
  EXPECT_GT(red(130, 200), red(270, 200));
}

TEST(Views, WindingDoesNotChangeThePicture) {
  Mesh mesh = body_like();
  const auto cameras = ring_cameras(mesh.vertices, 3, Framing());
  const auto right = render_views(prepared(mesh), cameras, ViewStyle(), Execution(1));
  Random random(2);
  for (const bool all : {true, false}) {
    Mesh turned = mesh;
    for (Index f = 0; f < turned.faces.cols(); ++f) {
      if (all || random.uniform() < 0.5) std::swap(turned.faces(1, f), turned.faces(2, f));
    }
    const auto views = render_views(prepared(turned), cameras, ViewStyle(), Execution(1));
    for (std::size_t k = 0; k < views.size(); ++k) {
      double difference = 0;
      for (std::size_t byte = 0; byte < views[k].rgb.size(); ++byte) {
        difference += std::abs(static_cast<int>(views[k].rgb[byte]) - static_cast<int>(right[k].rgb[byte]));
      }
      EXPECT_LT(difference / static_cast<double>(views[k].rgb.size()), 0.3);
    }
  }
}

TEST(Views, CloudsLookLikeTheirSurface) {
  const Mesh mesh = body_like();
  const auto cameras = ring_cameras(mesh.vertices, 4, Framing());
  const auto solid = render_views(prepared(mesh), cameras, ViewStyle(), Execution(1));
  const auto cloud = render_views(prepare_surface(mesh.vertices, Faces(3, 0), Points3f(3, 0), Execution(1)),
                                  cameras, ViewStyle(), Execution(1));
  for (std::size_t k = 0; k < solid.size(); ++k) {
    EXPECT_NEAR(mean_brightness(cloud[k]), mean_brightness(solid[k]), 20);
    EXPECT_NEAR(cloud[k].left, solid[k].left, 12);
    EXPECT_NEAR(cloud[k].bottom, solid[k].bottom, 12);
    int holes = 0;
    for (std::size_t pixel = 0; pixel < solid[k].depth.size(); ++pixel) {
      holes += std::isfinite(solid[k].depth[pixel]) && !std::isfinite(cloud[k].depth[pixel]);
    }
    EXPECT_LT(holes, 50);
  }
}

TEST(Views, SameForAnyNumberOfThreads) {
  const Mesh mesh = body_like();
  const auto cameras = ring_cameras(mesh.vertices, 5, Framing());
  const auto one = render_views(prepare_surface(mesh.vertices, mesh.faces, Points3f(3, 0), Execution(1)),
                                cameras, ViewStyle(), Execution(1));
  const auto three = render_views(prepare_surface(mesh.vertices, mesh.faces, Points3f(3, 0), Execution(3)),
                                  cameras, ViewStyle(), Execution(3));
  for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].rgb, three[k].rgb);
}

TEST(Views, EmptyAndBrokenInput) {
  const ViewSurface nothing = prepare_surface(Points3f(3, 0), Faces(3, 0), Points3f(3, 0), Execution(1));
  const View view =
      render_views(nothing, ring_cameras(nothing.vertices, 1, Framing()), ViewStyle(), Execution(1))[0];
  EXPECT_EQ(view.left, 0);
  EXPECT_EQ(view.right, 0);
  Faces wild(3, 1);
  wild << 0, 1, 7;
  EXPECT_THROW(prepare_surface(Points3f::Random(3, 3), wild, Points3f(3, 0), Execution(1)), Error);
  EXPECT_THROW(prepare_surface(Points3f::Random(3, 3), Faces(3, 0), Points3f(3, 2), Execution(1)), Error);
}

}  // namespace
}  // namespace vitruvian
