#include "fit/scan_target.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/random.h"

namespace vitruvian {
namespace {

TEST(ScanTarget, NearestStaysInsideTheVertexsRegion) {
  Random random(3);
  Points3f points(3, 400), normals(3, 400);
  RegionLabels labels{4, {}, {0, 1, 2, 3}};  // no point has label 3
  for (Index i = 0; i < 400; ++i) {
    for (int k = 0; k < 3; ++k) {
      points(k, i) = static_cast<float>(random.normal());
      normals(k, i) = static_cast<float>(random.normal());
    }
    normals.col(i).normalize();
    labels.scan.push_back(static_cast<int>(random.below(3)));
  }
  const ScanTarget target = ScanTarget::from_points(points, normals, labels);
  for (int query = 0; query < 50; ++query) {
    const Vec3f x(static_cast<float>(random.normal()), static_cast<float>(random.normal()), 0.2f);
    const Vec3f n = Vec3f(1, static_cast<float>(random.normal()), 0).normalized();
    for (const bool with_normals : {false, true}) {
      for (int vertex = 0; vertex < 3; ++vertex) {
        float least = std::numeric_limits<float>::infinity();
        int expected = -1;
        for (int i = 0; i < 400; ++i) {
          if (labels.scan[i] != vertex) continue;
          float d = (points.col(i) - x).squaredNorm();
          if (with_normals)
            d += ScanTarget::kNormalWeight * ScanTarget::kNormalWeight * (normals.col(i) - n).squaredNorm();
          if (d < least) least = d, expected = i;
        }
        EXPECT_EQ(target.nearest(vertex, x, n, with_normals).index, expected);
      }
      EXPECT_EQ(target.nearest(3, x, n, with_normals).index, -1) << "a region without points";
    }
  }
}

TEST(ScanTarget, SamplesTakeTheLabelOfTheNearestCorner) {
  Points3f vertices(3, 4);
  vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  Faces faces(3, 2);
  faces << 0, 0, 1, 2, 2, 3;
  const Points3f normals = Vec3f::UnitZ().replicate(1, 4);
  const RegionLabels labels{2, {1, 0, 0, 0}, {}};
  const ScanTarget target = ScanTarget::sample(vertices, faces, normals, 300, 5, labels);
  ASSERT_EQ(target.regions.scan.size(), 300u);
  for (Index i = 0; i < 300; ++i) {
    const Vec3f p = target.points.col(i);
    const bool near_first = p.head<2>().norm() < (p.head<2>() - Eigen::Vector2f(1, 0)).norm() &&
                            p.head<2>().norm() < (p.head<2>() - Eigen::Vector2f(1, 1)).norm() &&
                            p.head<2>().norm() < (p.head<2>() - Eigen::Vector2f(0, 1)).norm();
    EXPECT_EQ(target.regions.of_point(i), near_first ? 1 : 0) << p.transpose();
  }
}

}  // namespace
}  // namespace vitruvian
