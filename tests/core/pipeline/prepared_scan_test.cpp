#include "pipeline/prepared_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/align/body_shapes.h"

namespace vitruvian {
namespace {

/// A skittle of 1.7 m that stands on a floor of four square metres, `with_faces` or as a cloud; how many of
/// the vertices are the skittle's.
Scan standing_skittle(bool with_faces, Index& own) {
  const Shape shape = skittle();
  constexpr int kSide = 80;
  own = shape.vertices.cols();
  Scan scan;
  scan.vertices.resize(3, own + kSide * kSide);
  scan.vertices.leftCols(own) = shape.vertices;
  const float ground = shape.vertices.row(1).minCoeff();
  for (int i = 0; i < kSide * kSide; ++i) {
    scan.vertices.col(own + i) << 2.0f * static_cast<float>(i % kSide) / kSide - 1, ground,
        2.0f * static_cast<float>(i / kSide) / kSide - 1;
  }
  scan.faces.resize(3, 0);
  if (!with_faces) return scan;
  scan.faces.resize(3, shape.faces.cols() + 2 * (kSide - 1) * (kSide - 1));
  scan.faces.leftCols(shape.faces.cols()) = shape.faces;
  Index f = shape.faces.cols();
  for (int r = 0; r + 1 < kSide; ++r) {
    for (int c = 0; c + 1 < kSide; ++c) {
      const int a = static_cast<int>(own) + r * kSide + c;
      scan.faces.col(f++) << a, a + kSide, a + 1;
      scan.faces.col(f++) << a + 1, a + kSide, a + kSide + 1;
    }
  }
  return scan;
}

TEST(PreparedScan, LeavesAFloorOutOfTheBody) {
  for (const bool with_faces : {true, false}) {
    SCOPED_TRACE(with_faces);
    Index own = 0;
    Scan scan = standing_skittle(with_faces, own);
    const float ground = scan.vertices.row(1).minCoeff();
    const Execution execution(1);
    const PreparedScan prepared(std::move(scan), execution);
    ASSERT_FALSE(prepared.body_vertices.empty());
    EXPECT_GT(static_cast<double>(prepared.body_vertices.size()), 0.9 * static_cast<double>(own));
    EXPECT_LT(prepared.body_vertices.back(), own);
    if (with_faces) {
      EXPECT_GT(prepared.body_faces().cols(), 0);
      EXPECT_LT(prepared.body_faces().maxCoeff(), own);
    }
    const ScanTarget samples =
        sample_body(prepared, prepared.scan.vertices, prepared.normals, Mat4d::Identity(), 500, 1);
    EXPECT_GT(samples.points.row(1).minCoeff(), ground);
    const PlacedScan placed(prepared, Mat4d::Identity(), execution);
    EXPECT_EQ(placed.surface().body.size(), prepared.body_vertices.size());
    const Vec3f corner(1, ground, 1);
    EXPECT_LT(placed.surface().tree.nearest(corner).index, own);
  }
}

TEST(PreparedScan, SamplesKeepTheLabelsOfTheScansVertices) {
  for (const bool with_faces : {true, false}) {
    SCOPED_TRACE(with_faces);
    Index own = 0;
    Scan scan = standing_skittle(with_faces, own);
    // The floor comes first, so that a point's place among the body's is not its place in the scan.
    const Index floor = scan.vertices.cols() - own;
    Points3f turned(3, scan.vertices.cols());
    turned << scan.vertices.rightCols(floor), scan.vertices.leftCols(own);
    scan.vertices = turned;
    for (Index f = 0; f < scan.faces.cols(); ++f) {
      for (int k = 0; k < 3; ++k) {
        int& v = scan.faces(k, f);
        v = static_cast<int>(v < own ? v + floor : v - own);
      }
    }
    const float middle = scan.vertices.row(1).mean();
    RegionLabels labels{2, {}, {}};
    for (Index i = 0; i < scan.vertices.cols(); ++i) labels.scan.push_back(scan.vertices(1, i) > middle);
    const PreparedScan prepared(std::move(scan), Execution(1));
    ASSERT_FALSE(prepared.body_vertices.empty());
    const ScanTarget samples =
        sample_body(prepared, prepared.scan.vertices, prepared.normals, Mat4d::Identity(), 500, 1, labels);
    ASSERT_EQ(samples.regions.count, 2);
    ASSERT_EQ(samples.regions.scan.size(), static_cast<std::size_t>(samples.points.cols()));
    for (Index i = 0; i < samples.points.cols(); ++i) {
      const float height = samples.points(1, i) - middle;
      if (std::fabs(height) > 0.05f) EXPECT_EQ(samples.regions.of_point(i), height > 0 ? 1 : 0);
    }
  }
}

TEST(PreparedScan, KeepsAllOfAScanWithoutAFloor) {
  const Shape shape = skittle();
  Scan scan;
  scan.vertices = shape.vertices;
  scan.faces = shape.faces;
  const PreparedScan prepared(std::move(scan), Execution(1));
  EXPECT_TRUE(prepared.body_vertices.empty());
  EXPECT_EQ(prepared.body_faces().cols(), shape.faces.cols());
  EXPECT_EQ(prepared.rim.cols(), 0);
}

TEST(PreparedScan, FindsTheRimOfWhatWasCutOff) {
  const Shape shape = skittle();
  Scan scan;
  scan.vertices = shape.vertices;
  scan.faces = shape.faces;
  Index used = 0;
  for (Index f = 0; f < shape.faces.cols(); ++f) {
    if (shape.vertices(1, shape.faces(0, f)) < 0.3f) scan.faces.col(used++) = shape.faces.col(f);
  }
  scan.faces.conservativeResize(3, used);
  const PreparedScan prepared(std::move(scan), Execution(1));
  ASSERT_GT(prepared.rim.cols(), 10);
  EXPECT_NEAR(prepared.rim.row(1).minCoeff(), 0.3, 0.06);
  EXPECT_NEAR(prepared.rim.row(1).maxCoeff(), 0.3, 0.06);
  const ScanTarget samples =
      sample_body(prepared, prepared.scan.vertices, prepared.normals, Mat4d::Identity(), 3000, 1);
  ASSERT_EQ(samples.at_rim.size(), 3000u);
  int over_the_hole = 0;
  for (int i = 0; i < 3000; ++i) {
    over_the_hole += samples.unseen(i, 0.03f * 0.03f) ? 1 : 0;
    EXPECT_FALSE(samples.unseen(i, 0.01f * 0.01f));
    if (samples.points(1, i) < 0.24f) {
      EXPECT_FALSE(samples.unseen(i, 1));
    }
  }
  EXPECT_GT(over_the_hole, 20);
}

}  // namespace
}  // namespace vitruvian
