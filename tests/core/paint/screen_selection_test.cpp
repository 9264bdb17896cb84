#include "paint/screen_selection.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

struct Ball {
  Points3f vertices;
  Faces faces;
};

/// Unit sphere round `centre`, appended to what is there.
void add_ball(Ball& mesh, const Vec3f& centre, float radius, int rings) {
  const int sectors = 2 * rings, first = static_cast<int>(mesh.vertices.cols());
  Points3f points(3, (rings + 1) * sectors);
  for (int r = 0; r <= rings; ++r) {
    const double latitude = std::numbers::pi * (r + 0.001) / (rings + 0.002);
    for (int s = 0; s < sectors; ++s) {
      const double a = 2 * std::numbers::pi * s / sectors;
      points.col(r * sectors + s) =
          centre + radius * Vec3d(std::sin(latitude) * std::cos(a), std::cos(latitude),
                                  std::sin(latitude) * std::sin(a))
                                .cast<float>();
    }
  }
  Faces faces(3, 2 * rings * sectors);
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const int a = first + r * sectors + s, b = first + r * sectors + (s + 1) % sectors;
      faces.col(2 * (r * sectors + s)) << a, b, b + sectors;
      faces.col(2 * (r * sectors + s) + 1) << a, b + sectors, a + sectors;
    }
  }
  const Index vertices = mesh.vertices.cols(), triangles = mesh.faces.cols();
  mesh.vertices.conservativeResize(3, vertices + points.cols());
  mesh.vertices.rightCols(points.cols()) = points;
  mesh.faces.conservativeResize(3, triangles + faces.cols());
  mesh.faces.rightCols(faces.cols()) = faces;
}

/// Camera at (0, 0, distance) that looks along -Z, 35 degrees high, as three.js makes it.
Mat4d camera_at(double distance, double aspect, double turn) {
  const double f = 1 / std::tan(35.0 / 360 * std::numbers::pi), near = 0.01, far = 100;
  Mat4d projection = Mat4d::Zero();
  projection(0, 0) = f / aspect;
  projection(1, 1) = f;
  projection(2, 2) = (far + near) / (near - far);
  projection(2, 3) = 2 * far * near / (near - far);
  projection(3, 2) = -1;
  Eigen::Isometry3d view = Eigen::Isometry3d::Identity();
  view.pretranslate(Vec3d(0, 0, -distance));
  view.rotate(Eigen::AngleAxisd(turn, Vec3d::UnitY()));
  return projection * view.matrix();
}

TEST(ScreenSelection, SeesTheNearHalfOfABallAndNothingBehindIt) {
  for (const double turn : {0.0, 0.7, 3.0}) {
    for (const int rings : {12, 90}) {
      Ball ball;
      add_ball(ball, Vec3f::Zero(), 1, rings);
      const int own = static_cast<int>(ball.vertices.cols());
      // Smaller and wholly hidden, from wherever the camera looks.
      const Vec3f behind = (Eigen::AngleAxisd(-turn, Vec3d::UnitY()) * Vec3d(0, 0, -2)).cast<float>();
      add_ball(ball, behind, 0.4f, rings);
      const ScreenSelection view(ball.vertices, ball.faces, camera_at(5, 1.5, turn), 600, 400);
      const Vec3f eye = (Eigen::AngleAxisd(-turn, Vec3d::UnitY()) * Vec3d(0, 0, 5)).cast<float>();
      std::vector<bool> seen(static_cast<std::size_t>(ball.vertices.cols()), false);
      for (const int i : view.seen()) seen[static_cast<std::size_t>(i)] = true;
      for (int i = 0; i < static_cast<int>(ball.vertices.cols()); ++i) {
        const Vec3f p = ball.vertices.col(i);
        const float facing = p.dot((eye - p).normalized());
        // Within a pixel or two of the outline either is right.
        const bool is_seen = seen[static_cast<std::size_t>(i)];
        if (i >= own || facing < -0.15f) {
          EXPECT_FALSE(is_seen) << "turn " << turn << ", rings " << rings << ", vertex " << i;
        } else if (facing > 0.2f) {
          EXPECT_TRUE(is_seen) << "turn " << turn << ", rings " << rings << ", vertex " << i;
        }
      }
    }
  }
}

TEST(ScreenSelection, BrushAndLassoAgreeWithTheirDefinitionOnTheScreen) {
  Ball ball;
  add_ball(ball, Vec3f(0.1f, -0.2f, 0), 1, 40);
  const Mat4d camera = camera_at(4, 1, 0.3);
  const ScreenSelection view(ball.vertices, ball.faces, camera, 500, 500);
  const auto place = [&](int i) {
    const Eigen::Vector4d clip = camera * ball.vertices.col(i).cast<double>().homogeneous();
    return ScreenPoint((clip.x() / clip.w() + 1) * 250, (1 - clip.y() / clip.w()) * 250);
  };
  std::vector<int> in_box, in_stroke;
  for (const int i : view.seen()) {
    const ScreenPoint p = place(i);
    if (p.x() > 200 && p.x() < 300 && p.y() > 180 && p.y() < 260) in_box.push_back(i);
    const double along = std::clamp(p.x(), 220.0, 320.0);
    if (std::hypot(p.x() - along, p.y() - 240) < 40) in_stroke.push_back(i);
  }
  ASSERT_GT(in_box.size(), 20u);
  EXPECT_EQ(view.lasso({{200, 180}, {300, 180}, {300, 260}, {200, 260}}), in_box);
  EXPECT_EQ(view.lasso({{200, 260}, {300, 260}, {300, 180}, {200, 180}}), in_box);
  ASSERT_GT(in_stroke.size(), 20u);
  EXPECT_EQ(view.brush({220, 240}, {320, 240}, 40), in_stroke);
  EXPECT_TRUE(view.lasso({{200, 180}, {300, 180}}).empty());
  EXPECT_TRUE(view.brush({-90, -90}, {-90, -90}, 15).empty());
}

TEST(ScreenSelection, PointsHideWhatLiesBehindThem) {
  // Two sheets of points, the nearer one in front of the left half of the other.
  const int side = 60;
  Points3f points(3, 2 * side * side);
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const float u = static_cast<float>(i) / (side - 1), v = static_cast<float>(j) / (side - 1) - 0.5f;
      points.col(j * side + i) << u - 0.5f, v, 0;
      points.col(side * side + j * side + i) << 0.5f * u - 0.5f, v, 0.2f;
    }
  }
  const ScreenSelection view(points, Faces(3, 0), camera_at(4, 1, 0), 200, 200);
  int left = 0, right = 0, front = 0;
  for (const int i : view.seen()) {
    if (i >= side * side)
      ++front;
    else if (points(0, i) < -0.05f)
      ++left;
    else if (points(0, i) > 0.05f)
      ++right;
  }
  EXPECT_EQ(front, side * side);
  EXPECT_LT(left, side * side / 50);
  EXPECT_GT(right, side * side / 2 * 8 / 10);
}

TEST(ScreenSelection, WhatIsBehindTheCameraOrNotFiniteIsNotSeen) {
  Ball ball;
  add_ball(ball, Vec3f::Zero(), 1, 10);
  const ScreenSelection within(ball.vertices, ball.faces, camera_at(0, 1, 0), 100, 100);
  for (const int i : within.seen()) EXPECT_LT(ball.vertices(2, i), 0);
  ball.vertices.col(7).setConstant(std::nanf(""));
  const ScreenSelection view(ball.vertices, ball.faces, camera_at(5, 1, 0), 100, 100);
  EXPECT_FALSE(std::binary_search(view.seen().begin(), view.seen().end(), 7));
  EXPECT_TRUE(ScreenSelection(Points3f(3, 0), Faces(3, 0), camera_at(5, 1, 0), 10, 10).seen().empty());
}

TEST(ScreenSelection, RefusesViewsThatAreNone) {
  const Points3f none(3, 0);
  const Faces faces(3, 0);
  EXPECT_THROW(ScreenSelection(none, faces, camera_at(5, 1, 0), 0, 10), Error);
  EXPECT_THROW(ScreenSelection(none, faces, camera_at(5, 1, 0), 10, 1 << 20), Error);
  EXPECT_THROW(ScreenSelection(none, faces, Mat4d::Constant(std::nan("")), 10, 10), Error);
}

}  // namespace
}  // namespace vitruvian
