#include "detail/scan_pull.h"

#include <gtest/gtest.h>

#include <optional>

#include "core/geometry/solids.h"

namespace vitruvian {
namespace {

constexpr PullSettings kSettings{0.05, 0.03, 0.5};

/// Unit sphere; a scan of it by another, finer one.
struct Balls {
  testing::Solid model = testing::sphere(24, 36);
  Points3f model_normals = vertex_normals(model.vertices, model.faces);
  Eigen::VectorXd areas = vertex_areas(model.vertices, model.faces).cast<double>();
  Points3f points, normals;
  Faces faces;
  KdTree tree;
  std::optional<ClosestPointOnMesh> mesh;

  /// @param keep  which triangles of the scan remain, by their centre.
  template <typename Keep>
  Balls(float radius, double noise, const Keep& keep) {
    const testing::Solid fine = testing::sphere(120, 180);
    points = radius * fine.vertices;
    Random random(3);
    for (Index v = 0; v < points.cols(); ++v)
      points.col(v) *= static_cast<float>(1 + noise * random.normal());
    faces.resize(3, fine.faces.cols());
    Index kept = 0;
    for (Index f = 0; f < fine.faces.cols(); ++f) {
      const Vec3f centre = (fine.vertices.col(fine.faces(0, f)) + fine.vertices.col(fine.faces(1, f)) +
                            fine.vertices.col(fine.faces(2, f))) /
                           3;
      if (keep(centre)) faces.col(kept++) = fine.faces.col(f);
    }
    faces.conservativeResize(3, kept);
    normals = vertex_normals(points, faces);
    tree = KdTree(points);
    mesh.emplace(points, faces);
  }
  explicit Balls(float radius, double noise = 0) : Balls(radius, noise, [](const Vec3f&) { return true; }) {}

  Pull pull(int threads = 1, const PullSettings& settings = kSettings) const {
    const Execution execution(threads);
    const SurfaceSamples samples = sample_surface(points, faces, normals, 30000, 1);
    return pull_of_scan(samples, {points, normals, faces, tree, mesh ? &*mesh : nullptr}, model.vertices,
                        model_normals, model.faces, areas, settings, execution);
  }
};

TEST(ScanPull, LeadsToTheScan) {
  const Balls balls(1.01f);
  const Pull pull = balls.pull();
  for (Index v = 0; v < pull.weight.size(); ++v) {
    ASSERT_GT(pull.weight[v], 0.5) << v;
    // The model's triangles lie up to 3 mm inside the unit sphere.
    const Vec3d outward = balls.model.vertices.col(v).cast<double>();
    EXPECT_NEAR(pull.displacement.col(v).dot(outward), 0.011, 0.003) << v;
  }
}

TEST(ScanPull, SurfaceFacingTheOtherWayDoesNotDraw) {
  Balls balls(1.01f);
  balls.normals *= -1;
  const Pull pull = balls.pull();
  EXPECT_EQ(pull.weight.maxCoeff(), 0);
  EXPECT_EQ(pull.displacement.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(pull.roughness, 0);
}

TEST(ScanPull, NothingDrawsFromBeyondItsReach) { EXPECT_EQ(Balls(1.08f).pull().weight.maxCoeff(), 0); }

TEST(ScanPull, HolesAndTheirRimsDoNotDraw) {
  const Balls balls(1.01f, 0, [](const Vec3f& centre) { return centre.z() < 0.5f; });
  const Pull pull = balls.pull();
  for (Index v = 0; v < pull.weight.size(); ++v) {
    const Vec3d at = balls.model.vertices.col(v).cast<double>();
    if (at.z() > 0.62) {
      EXPECT_EQ(pull.weight[v], 0) << at.transpose();
    } else if (at.z() < 0.45) {
      EXPECT_GT(pull.weight[v], 0.5) << at.transpose();
    }
    // Near the rim whatever draws does so outward, not towards the rim.
    if (pull.weight[v] > 0) {
      EXPECT_LT((pull.displacement.col(v) - 0.0115 * at).norm(), 0.006) << at.transpose();
    }
  }
}

TEST(ScanPull, NoiseIsNoticedAndAveragedOut) {
  const Pull clean = Balls(1.0f).pull(), noisy = Balls(1.0f, 0.005).pull();
  EXPECT_LT(clean.roughness, 0.002);
  EXPECT_GT(noisy.roughness, 0.0025);
  EXPECT_LT(noisy.roughness, 0.007);
  const Pull samples_only = Balls(1.0f, 0.005).pull(1, {0.05, 0.03, 0});
  EXPECT_LT((samples_only.displacement - clean.displacement).colwise().norm().mean(), 0.0025);
}

TEST(ScanPull, BareCloudsDrawLikeMeshes) {
  Balls balls(1.01f);
  const Pull from_mesh = balls.pull();
  balls.faces.resize(3, 0);
  balls.mesh.reset();
  const Pull from_cloud = balls.pull();
  EXPECT_GT(from_cloud.weight.minCoeff(), 0.5);
  EXPECT_LT((from_cloud.displacement - from_mesh.displacement).colwise().norm().maxCoeff(), 0.002);
}

TEST(ScanPull, DoesNotDependOnTheThreads) {
  const Balls balls(1.01f, 0.002);
  const Pull one = balls.pull(1), three = balls.pull(3);
  EXPECT_EQ(one.displacement, three.displacement);
  EXPECT_EQ(one.weight, three.weight);
  EXPECT_EQ(one.roughness, three.roughness);
}

}  // namespace
}  // namespace vitruvian
