#include "paint/canvas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

/// A square sheet of n x n vertices from -0.5 to 0.5 in x and y, at a depth.
Points3f sheet(int n, float z) {
  Points3f points(3, n * n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      points.col(j * n + i) << static_cast<float>(i) / (n - 1) - 0.5f, static_cast<float>(j) / (n - 1) - 0.5f,
          z;
    }
  }
  return points;
}

Faces sheet_faces(int n) {
  Faces faces(3, 2 * (n - 1) * (n - 1));
  Index f = 0;
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const int a = j * n + i;
      faces.col(f++) << a, a + 1, a + n + 1;
      faces.col(f++) << a, a + n + 1, a + n;
    }
  }
  return faces;
}

/// From +Z, `distance` away, 200 x 200 pixels.
PaintCamera camera(double distance) {
  PaintCamera result{Mat4d::Zero(), 200, 200};
  const double near = 0.01, far = 100;
  result.clip_from_mesh(0, 0) = result.clip_from_mesh(1, 1) = 4;
  result.clip_from_mesh(2, 2) = (far + near) / (near - far);
  result.clip_from_mesh(2, 3) = 2 * far * near / (near - far) - distance * (far + near) / (near - far);
  result.clip_from_mesh(3, 2) = -1;
  result.clip_from_mesh(3, 3) = distance;
  return result;
}

TEST(PaintCanvas, AWayIsTheUnionOfItsPieces) {
  const int n = 50;
  const Points3f points = sheet(n, 0);
  const Faces faces = sheet_faces(n);
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<ScreenPoint> way;
    for (int i = 0; i < 5; ++i)
      way.emplace_back(static_cast<double>(random.below(200)), static_cast<double>(random.below(200)));
    PaintCanvas canvas(points, faces);
    const ScreenSelection seen(points, faces, camera(5).clip_from_mesh, 200, 200);
    std::vector<bool> wanted(static_cast<std::size_t>(points.cols()), false);
    for (std::size_t i = 1; i < way.size(); ++i)
      for (const int v : seen.brush(way[i - 1], way[i], 9)) wanted[static_cast<std::size_t>(v)] = true;
    std::vector<int> expected;
    for (std::size_t v = 0; v < wanted.size(); ++v)
      if (wanted[v]) expected.push_back(static_cast<int>(v));
    EXPECT_EQ(canvas.brush(camera(5), way, 9), expected);
  }
}

TEST(PaintCanvas, AnotherCameraSeesAnew) {
  const Points3f points = sheet(40, 0);
  const Faces faces = sheet_faces(40);
  PaintCanvas canvas(points, faces);
  const std::vector<ScreenPoint> dab = {{100, 100}};
  const std::size_t near = canvas.brush(camera(5), dab, 20).size();
  const std::size_t far = canvas.brush(camera(10), dab, 20).size();
  EXPECT_GT(near, 20u);
  // Twice as far: four times the area in the same circle.
  EXPECT_NEAR(static_cast<double>(far) / static_cast<double>(near), 4, 0.6);
  EXPECT_EQ(canvas.brush(camera(5), dab, 20).size(), near);
}

TEST(PaintCanvas, APartEndsAtItsLabelAndReachesWhatIsHidden) {
  const int n = 30;
  const Points3f points = sheet(n, 0);
  std::vector<std::uint8_t> label(static_cast<std::size_t>(n) * n, 1);
  for (int j = 0; j < n; ++j) label[static_cast<std::size_t>(j * n + n / 2)] = 2;
  const Faces faces = sheet_faces(n);
  PaintCanvas mesh(points, faces);
  // Left of the line that parts the sheet; from so near that its rims are out of the picture.
  const std::vector<int> left = mesh.part(camera(1.5), {60, 100}, 20, label);
  EXPECT_EQ(left.size(), static_cast<std::size_t>(n) * (n / 2));
  for (const int v : left) EXPECT_LT(v % n, n / 2);
  EXPECT_TRUE(mesh.part(camera(50), {1, 1}, 20, label).empty());
  // Points are not connected: both sides.
  const Faces none(3, 0);
  PaintCanvas cloud(points, none);
  EXPECT_EQ(cloud.part(camera(5), {60, 100}, 40, label).size(), static_cast<std::size_t>(n) * (n - 1));
}

TEST(PaintCanvas, RefusesACameraThatIsNone) {
  const Points3f points = sheet(3, 0);
  const Faces faces = sheet_faces(3);
  PaintCanvas canvas(points, faces);
  PaintCamera broken = camera(5);
  broken.width = 0;
  EXPECT_THROW(canvas.brush(broken, {{1, 1}}, 5), Error);
  EXPECT_EQ(canvas.lasso(camera(5), {{0, 0}, {200, 0}, {200, 200}, {0, 200}}).size(), 9u);
}

}  // namespace
}  // namespace vitruvian
