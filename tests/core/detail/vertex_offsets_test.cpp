#include "detail/vertex_offsets.h"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>

#include "core/fit/fit_fixtures.h"
#include "detail/folds.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

using testing::default_body;

/// Offsets that no betas can make: waves of 12 cm and an amplitude of `amplitude`, outward and inward.
Points3f wavy_offsets(float amplitude) {
  const BodyModel& body = default_body();
  const Points3f normals = vertex_normals(body.v_template, body.faces);
  Points3f offsets(3, body.vertex_count());
  for (Index v = 0; v < offsets.cols(); ++v) {
    const Vec3f phase = 2 * std::numbers::pi_v<float> / 0.12f * body.v_template.col(v);
    offsets.col(v) = amplitude * (std::sin(phase.x()) * std::cos(phase.y()) + 0.3f) * normals.col(v);
  }
  return offsets;
}

/// The scan of a body: dense samples of its surface, as a mesh or as a cloud.
struct BodyScan {
  Points3f points, normals;
  Faces faces;
  KdTree tree;
  std::optional<ClosestPointOnMesh> mesh;

  /// Each triangle is cut into four, so that the scan has vertices of its own.
  BodyScan(const Points3d& vertices, const Faces& coarse) {
    const Index count = vertices.cols();
    points.resize(3, count + 3 * coarse.cols());
    points.leftCols(count) = vertices.cast<float>();
    faces.resize(3, 4 * coarse.cols());
    for (Index f = 0; f < coarse.cols(); ++f) {
      int corner[3], middle[3];
      for (int k = 0; k < 3; ++k) {
        corner[k] = coarse(k, f);
        middle[k] = static_cast<int>(count + 3 * f + k);
        points.col(middle[k]) = (points.col(coarse(k, f)) + points.col(coarse((k + 1) % 3, f))) / 2;
      }
      faces.col(4 * f) << middle[0], middle[1], middle[2];
      for (int k = 0; k < 3; ++k) faces.col(4 * f + 1 + k) << corner[k], middle[k], middle[(k + 2) % 3];
    }
    index();
  }

  void index() {
    normals = vertex_normals(points, faces);
    tree = KdTree(points);
    mesh.reset();
    if (faces.cols() > 0) mesh.emplace(points, faces);
  }
  template <typename Keep>
  void keep_faces(const Keep& keep) {
    Index kept = 0;
    for (Index f = 0; f < faces.cols(); ++f) {
      const Vec3f centre = (points.col(faces(0, f)) + points.col(faces(1, f)) + points.col(faces(2, f))) / 3;
      if (keep(centre)) faces.col(kept++) = faces.col(f).eval();
    }
    faces.conservativeResize(3, kept);
    index();
  }
  void add_noise(double sigma, std::uint32_t seed) {
    Random random(seed);
    for (Index v = 0; v < points.cols(); ++v) {
      points.col(v) += static_cast<float>(sigma * random.normal()) * normals.col(v);
    }
    index();
  }
  void forget_faces() {
    faces.resize(3, 0);
    mesh.reset();
  }
  ScanSurface surface() const { return {points, normals, faces, tree, mesh ? &*mesh : nullptr}; }
};

class VertexOffsets : public ::testing::Test {
 protected:
  BodyState state_ = testing::test_state(3, 8);
  Points3f truth_ = wavy_offsets(0.006f);
  Points3d parametric_ = posed_vertices<double>(default_body(), state_);
  Points3d true_vertices_ = posed_vertices<double>(default_body(), state_, truth_);
  BodyScan scan_{true_vertices_, default_body().faces};

  Points3d refined(const ScanSurface& scan, int threads = 2) {
    offsets_ = vertex_offsets(default_body(), state_, scan, DetailSettings(), Execution(threads));
    const Points3d vertices = posed_vertices<double>(default_body(), state_, offsets_);
    EXPECT_TRUE(vertices.allFinite());
    EXPECT_TRUE(folded_faces(parametric_, vertices - parametric_, default_body().faces).empty());
    return vertices;
  }
  /// Mean distance of the chosen vertices to the true surface, mm.
  template <typename Chosen>
  double mean_error_mm(const Points3d& vertices, const Chosen& chosen) const {
    const ClosestPointOnMesh truth(true_vertices_.cast<float>(), default_body().faces);
    double sum = 0, count = 0;
    for (Index v = 0; v < vertices.cols(); ++v) {
      if (!chosen(Vec3f(true_vertices_.col(v).cast<float>()))) continue;
      sum += truth.query(vertices.col(v).cast<float>()).distance;
      count += 1;
    }
    EXPECT_GT(count, 100);
    return 1e3 * sum / count;
  }
  double mean_error_mm(const Points3d& vertices) const {
    return mean_error_mm(vertices, [](const Vec3f&) { return true; });
  }

  Points3f offsets_;
};

TEST_F(VertexOffsets, MeetTheScan) {
  EXPECT_GT(mean_error_mm(parametric_), 2.5);
  EXPECT_LT(mean_error_mm(refined(scan_.surface())), 0.4);
}

TEST_F(VertexOffsets, MeetABareCloud) {
  scan_.forget_faces();
  EXPECT_LT(mean_error_mm(refined(scan_.surface())), 0.6);
}

TEST_F(VertexOffsets, NoiseIsSmoothedAway) {
  scan_.add_noise(0.005, 4);
  EXPECT_LT(mean_error_mm(refined(scan_.surface())), 1.8) << "the noise alone has a mean of 4 mm";
}

TEST_F(VertexOffsets, AParametricBodyStaysOne) {
  const BodyScan exact(parametric_, default_body().faces);
  refined(exact.surface());
  EXPECT_LT(1e3 * offsets_.colwise().norm().mean(), 0.2);
}

TEST_F(VertexOffsets, HolesAreBridged) {
  // Balls of 5 cm cut out all over the body, a sixth of it.
  const auto inside = [&](const Vec3f& x) {
    return (x / 0.15f - (x / 0.15f).array().round().matrix()).norm() * 0.15f < 0.05f;
  };
  scan_.keep_faces([&](const Vec3f& x) { return !inside(x); });
  const Points3d vertices = refined(scan_.surface());
  EXPECT_LT(mean_error_mm(vertices, [&](const Vec3f& x) { return !inside(x); }), 0.6);
  EXPECT_LT(mean_error_mm(vertices, inside), 0.6 * mean_error_mm(parametric_, inside));
}

TEST_F(VertexOffsets, WhatWasNotSeenStaysParametric) {
  // Only the upper half was scanned.
  const float middle = static_cast<float>(true_vertices_.row(1).mean());
  scan_.keep_faces([&](const Vec3f& x) { return x.y() > middle; });
  const Points3d vertices = refined(scan_.surface());
  EXPECT_LT(mean_error_mm(vertices, [&](const Vec3f& x) { return x.y() > middle + 0.02f; }), 0.5);
  double far = 0;
  for (Index v = 0; v < vertices.cols(); ++v) {
    if (true_vertices_(1, v) < middle - 0.3) {
      far = std::max(far, (vertices.col(v) - parametric_.col(v)).norm());
    }
  }
  EXPECT_LT(far, 0.004);
}

TEST_F(VertexOffsets, FloorAndStraysDoNotDraw) {
  const Points3d alone = refined(scan_.surface());
  const Index own = scan_.points.cols();
  const Vec3f low = scan_.points.rowwise().minCoeff(), high = scan_.points.rowwise().maxCoeff();
  constexpr int kSide = 60;
  Random random(5);
  scan_.points.conservativeResize(3, own + kSide * kSide + 300);
  for (int i = 0; i < kSide * kSide; ++i) {
    scan_.points.col(own + i) << low.x() + (high.x() - low.x()) * static_cast<float>(i % kSide) / (kSide - 1),
        low.y(), low.z() + (high.z() - low.z()) * static_cast<float>(i / kSide) / (kSide - 1);
  }
  const Index before = scan_.faces.cols();
  scan_.faces.conservativeResize(3, before + 2 * (kSide - 1) * (kSide - 1) + 100);
  Index face = before;
  for (int r = 0; r + 1 < kSide; ++r) {
    for (int c = 0; c + 1 < kSide; ++c) {
      const int a = static_cast<int>(own) + r * kSide + c;
      scan_.faces.col(face++) << a, a + kSide, a + 1;
      scan_.faces.col(face++) << a + 1, a + kSide, a + kSide + 1;
    }
  }
  Vec3f crumb;
  for (int i = 0; i < 300; ++i) {
    // A crumb: three corners within 2 cm.
    for (int k = 0; k < 3; ++k) {
      if (i % 3 == 0) crumb[k] = static_cast<float>(random.uniform(low[k], high[k]));
      scan_.points(k, own + kSide * kSide + i) = crumb[k] + static_cast<float>(random.uniform(-0.01, 0.01));
    }
    if (i % 3 == 2) {
      const int a = static_cast<int>(own) + kSide * kSide + i;
      scan_.faces.col(face++) << a - 2, a - 1, a;
    }
  }
  scan_.index();
  const Points3d together = refined(scan_.surface());
  EXPECT_LT(1e3 * (together - alone).colwise().norm().mean(), 0.3);
  EXPECT_LT(mean_error_mm(together), 0.7);
}

TEST_F(VertexOffsets, TwoRunsAndAnyNumberOfThreadsGiveTheSame) {
  refined(scan_.surface(), 1);
  const Points3f first = offsets_;
  refined(scan_.surface(), 3);
  EXPECT_EQ(offsets_, first);
}

TEST_F(VertexOffsets, CanBeCancelled) {
  Execution execution(1);
  execution.cancel();
  EXPECT_THROW(vertex_offsets(default_body(), state_, scan_.surface(), DetailSettings(), execution), Error);
}

}  // namespace
}  // namespace vitruvian
