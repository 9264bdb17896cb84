#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/random.h"
#include "body/model.h"
#include "geometry/mesh.h"
#include "measure/surface_error_compute.h"

namespace vitruvian {
namespace {

struct Mesh {
  Points3f vertices, normals;
  Faces faces;
};

/// Unit sphere by subdivision of an octahedron, scaled and shifted.
Mesh sphere(int subdivisions, float radius, const Vec3f& centre) {
  std::vector<Vec3f> points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Eigen::Vector3i> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (fresh) points.push_back((points[a] + points[b]).normalized());
      return place->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& f : faces) {
      const int a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {a, f[1], b}, {c, b, f[2]}, {a, b, c}});
    }
    faces = finer;
  }
  Mesh mesh{Points3f(3, points.size()), Points3f(3, points.size()), Faces(3, faces.size())};
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.normals.col(i) = points[i];
    mesh.vertices.col(i) = centre + radius * points[i];
  }
  for (std::size_t f = 0; f < faces.size(); ++f) mesh.faces.col(f) = faces[f];
  return mesh;
}

/// A flat square of (n + 1)^2 vertices in the plane z = `height`, normals +z.
Mesh square(int n, float side, float height) {
  Mesh mesh{Points3f(3, (n + 1) * (n + 1)), Points3f(3, (n + 1) * (n + 1)), Faces(3, 2 * n * n)};
  for (int r = 0; r <= n; ++r) {
    for (int c = 0; c <= n; ++c) {
      mesh.vertices.col(r * (n + 1) + c) = Vec3f(side * c / n - side / 2, side * r / n - side / 2, height);
      mesh.normals.col(r * (n + 1) + c) = Vec3f::UnitZ();
    }
  }
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      const int a = r * (n + 1) + c, b = a + 1, d = a + n + 1, e = d + 1;
      mesh.faces.col(2 * (r * n + c)) = Eigen::Vector3i(a, b, e);
      mesh.faces.col(2 * (r * n + c) + 1) = Eigen::Vector3i(a, e, d);
    }
  }
  return mesh;
}

SurfaceMeasurement measure(const Mesh& model, const std::vector<std::uint8_t>& segment, const Mesh& scan,
                           bool as_cloud = false, int threads = 1) {
  const KdTree tree(scan.vertices);
  std::optional<ClosestPointOnMesh> surface;
  if (!as_cloud) surface.emplace(scan.vertices, scan.faces);
  const Faces none(3, 0);
  return measure_surface(
      {model.vertices, model.normals, model.faces, segment},
      {scan.vertices, scan.normals, as_cloud ? none : scan.faces, tree, surface ? &*surface : nullptr},
      Execution(threads));
}

TEST(SurfaceError, ConcentricSpheresDifferByTheirRadii) {
  const Mesh model = sphere(5, 0.300f, Vec3f::Zero()), scan = sphere(6, 0.305f, Vec3f::Zero());
  const SurfaceMeasurement m = measure(model, std::vector<std::uint8_t>(model.vertices.cols(), 15), scan);
  EXPECT_EQ(m.error.observed, 1);
  ASSERT_TRUE(m.error.surface_segments[15].statistics);
  EXPECT_EQ(m.error.surface_segments[15].segment, "head");
  EXPECT_EQ(m.error.surface_segments[15].statistics->count, model.vertices.cols());
  EXPECT_NEAR(m.error.surface_all.mean_mm, 5, 0.1);
  EXPECT_NEAR(m.error.surface_all.max_mm, 5, 0.1);
  EXPECT_NEAR(m.error.scan_to_model.mean_mm, 5, 0.3);
  EXPECT_EQ(m.error.scan_to_model.count, scan.vertices.cols());
  EXPECT_GE(m.error.all.mean_mm, m.error.surface_all.mean_mm)
      << "a point of the scan is never nearer than its surface";
  EXPECT_EQ(m.opposed_share, 0);
}

TEST(SurfaceError, PerfectFitReadsZeroOnTheSurfaceAndTheSamplingFloorOnPoints) {
  const Mesh scan = square(20, 1, 0);
  Mesh model = square(40, 0.9f, 0);
  const SurfaceMeasurement m = measure(model, std::vector<std::uint8_t>(model.vertices.cols(), 9), scan);
  EXPECT_LT(m.error.surface_all.max_mm, 1e-3);
  EXPECT_GT(m.error.all.mean_mm, 5);
}

TEST(SurfaceError, ShiftedSquareReadsTheShift) {
  const Mesh scan = square(30, 1, 0), model = square(11, 0.8f, 0.012f);
  const SurfaceMeasurement m = measure(model, std::vector<std::uint8_t>(model.vertices.cols(), 0), scan);
  EXPECT_NEAR(m.error.surface_all.mean_mm, 12, 1e-3);
  EXPECT_NEAR(m.error.surface_all.std_mm, 0, 1e-3);
  const SurfaceMeasurement cloud =
      measure(model, std::vector<std::uint8_t>(model.vertices.cols(), 0), scan, true);
  EXPECT_NEAR(cloud.error.surface_all.mean_mm, 12, 1e-2) << "the local plane of a flat cloud is the plane";
}

TEST(SurfaceError, UnseenSegmentHasNoStatisticsAndLeavesThePool) {
  Mesh model = square(20, 1, 0.001f);
  std::vector<std::uint8_t> segment(model.vertices.cols());
  for (Index v = 0; v < model.vertices.cols(); ++v) segment[v] = model.vertices(0, v) < 0 ? 4 : 5;
  Mesh scan = square(100, 1, 0);
  std::vector<Eigen::Vector3i> kept;
  for (Index f = 0; f < scan.faces.cols(); ++f) {
    if (scan.vertices(0, scan.faces(0, f)) < -0.05f) kept.push_back(scan.faces.col(f));
  }
  Faces faces(3, kept.size());
  for (std::size_t f = 0; f < kept.size(); ++f) faces.col(f) = kept[f];
  Points3f seen = scan.vertices;
  for (Index i = 0; i < seen.cols(); ++i) {
    if (seen(0, i) > -0.05f) seen.col(i) = scan.vertices.col(0);
  }
  const SurfaceMeasurement m = measure(model, segment, {seen, scan.normals, faces});
  EXPECT_TRUE(m.error.surface_segments[4].statistics);
  EXPECT_GT(m.error.surface_segments[4].observed, 0.9);
  EXPECT_FALSE(m.error.surface_segments[5].statistics);
  EXPECT_FALSE(m.error.segments[5].statistics);
  EXPECT_EQ(m.error.surface_segments[5].observed, 0);
  EXPECT_EQ(m.error.surface_all.count, m.error.surface_segments[4].statistics->count);
  EXPECT_FALSE(m.error.surface_segments[11].statistics) << "a segment without vertices";
}

TEST(SurfaceError, BackToBackSurfacesAreNotObservedAndOpposed) {
  Mesh scan = square(50, 1, 0);
  const Mesh model = square(20, 0.9f, 0.005f);
  scan.normals = -scan.normals;
  const SurfaceMeasurement m = measure(model, std::vector<std::uint8_t>(model.vertices.cols(), 3), scan);
  EXPECT_EQ(m.error.observed, 0);
  EXPECT_EQ(m.opposed_share, 1);
  scan.normals.setZero();
  const SurfaceMeasurement unknown =
      measure(model, std::vector<std::uint8_t>(model.vertices.cols(), 3), scan);
  EXPECT_EQ(unknown.error.observed, 1) << "unknown normals speak against nothing";
  EXPECT_EQ(unknown.opposed_share, 0);
}

TEST(SurfaceError, CloudDistanceIsBoundedByTheCloudsEdge) {
  const Mesh scan = square(20, 1, 0);
  const KdTree tree(scan.vertices);
  EXPECT_NEAR(distance_to_cloud(Vec3f(0.01f, 0.02f, 0.03f), scan.vertices, tree), 0.03f, 1e-4f);
  const float beyond = distance_to_cloud(Vec3f(1.5f, 0, 0), scan.vertices, tree);
  EXPECT_GT(beyond, 0.85f);
  EXPECT_LE(beyond, 1.0f);
  const Points3f two = scan.vertices.leftCols(2);
  EXPECT_NEAR(distance_to_cloud(two.col(0) + Vec3f(0, 0, 1), two, KdTree(two)), 1, 1e-5f);
}

TEST(SurfaceError, DistancesAgreeWithBruteForceOnRandomTriangles) {
  for (const std::uint32_t seed : {21u, 22u}) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Mesh scan = sphere(2, 0.5f, Vec3f::Zero());
    for (Index i = 0; i < scan.vertices.size(); ++i)
      scan.vertices(i) += static_cast<float>(0.05 * random.normal());
    scan.normals = vertex_normals(scan.vertices, scan.faces);
    const Mesh model = sphere(3, 0.55f, Vec3f(0.02f, 0, 0.01f));
    const SurfaceMeasurement m = measure(model, std::vector<std::uint8_t>(model.vertices.cols(), 1), scan);
    // Dense sampling of every triangle: never nearer than the exact distance, and nearly as near.
    for (Index v = 0; v < model.vertices.cols(); v += 7) {
      float best = 1e9f;
      for (Index f = 0; f < scan.faces.cols(); ++f) {
        const Vec3f a = scan.vertices.col(scan.faces(0, f)), b = scan.vertices.col(scan.faces(1, f)),
                    c = scan.vertices.col(scan.faces(2, f));
        for (int i = 0; i <= 20; ++i) {
          for (int j = 0; i + j <= 20; ++j) {
            const Vec3f p =
                (a * static_cast<float>(i) + b * static_cast<float>(j) + c * static_cast<float>(20 - i - j)) /
                20;
            best = std::min(best, (p - Vec3f(model.vertices.col(v))).norm());
          }
        }
      }
      EXPECT_LE(m.surface_distance_m[v], best + 1e-6f);
      EXPECT_GT(m.surface_distance_m[v], best - 0.012f);
    }
  }
}

TEST(SurfaceError, LargeScansAreSampledEvenlyAndThreadsDoNotMatter) {
  const Mesh model = sphere(4, 0.3f, Vec3f::Zero()), scan = sphere(7, 0.303f, Vec3f(0.002f, 0, 0));
  ASSERT_GT(scan.vertices.cols(), 60000);
  const std::vector<std::uint8_t> segment(model.vertices.cols(), 0);
  const SurfaceMeasurement one = measure(model, segment, scan),
                           three = measure(model, segment, scan, false, 3);
  EXPECT_EQ(one.error.scan_to_model.count, 50000);
  EXPECT_TRUE(std::is_sorted(one.sampled_point.begin(), one.sampled_point.end()));
  EXPECT_LT(one.sampled_point.front(), 2);
  EXPECT_GT(one.sampled_point.back(), scan.vertices.cols() - 3);
  EXPECT_EQ(one.surface_distance_m, three.surface_distance_m);
  EXPECT_EQ(one.sampled_distance_m, three.sampled_distance_m);
  EXPECT_EQ(one.matched_point, three.matched_point);
  EXPECT_EQ(one.error.all.mean_mm, three.error.all.mean_mm);
}

TEST(SurfaceError, RefusesContradictingSizes) {
  const Mesh model = square(3, 1, 0), scan = square(3, 1, 0);
  EXPECT_THROW(measure(model, std::vector<std::uint8_t>(2), scan), Error);
}

}  // namespace
}  // namespace vitruvian
