#include "fit/chamfer.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/random.h"
#include "core/numeric_jacobian.h"

namespace vitruvian {
namespace {

Points3f cloud(Index count, std::uint32_t seed) {
  Random random(seed);
  Points3f points(3, count);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] = static_cast<float>(random.normal());
  return points;
}

/// Mean distance from each of `from` with a label to the nearest of `to` with that label, in double.
double mean_nearest(const Points3d& from, const std::vector<int>& from_label, const Points3f& to,
                    const std::vector<int>& to_label, int label) {
  double sum = 0;
  int count = 0;
  for (Index i = 0; i < from.cols(); ++i) {
    if (from_label[i] != label) continue;
    double least = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < to.cols(); ++j) {
      if (to_label[j] == label) least = std::min(least, (from.col(i) - to.col(j).cast<double>()).norm());
    }
    sum += least;
    ++count;
  }
  return sum / count;
}

/// The definition, by brute force in double.
double chamfer(const Points3d& vertices, const std::vector<int>& vertex_label, const Points3f& scan,
               const std::vector<int>& scan_label, int labels, bool one_directional) {
  double value = 0;
  const Points3f vertices_float = vertices.cast<float>();
  for (int label = 0; label < labels; ++label) {
    value += mean_nearest(vertices, vertex_label, scan, scan_label, label);
    if (one_directional) continue;
    double sum = 0;
    int count = 0;
    for (Index i = 0; i < scan.cols(); ++i) {
      if (scan_label[i] != label) continue;
      double least = std::numeric_limits<double>::infinity();
      for (Index v = 0; v < vertices.cols(); ++v) {
        if (vertex_label[v] == label)
          least = std::min(least, (scan.col(i).cast<double>() - vertices.col(v)).norm());
      }
      sum += least;
      ++count;
    }
    value += sum / count;
  }
  return value;
}

struct Case {
  Points3f vertices, scan;
  RegionLabels regions;
};

Case make_case(std::uint32_t seed, int labels) {
  Case c{cloud(60, seed), cloud(90, seed + 50), {labels, {}, {}}};
  Random random(seed + 99);
  for (int i = 0; i < 90; ++i) c.regions.scan.push_back(static_cast<int>(random.below(labels)));
  for (int v = 0; v < 60; ++v) c.regions.vertices.push_back(static_cast<int>(random.below(labels)));
  return c;
}

TEST(Chamfer, ValueAndGradientAreTheDefinitions) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    for (const int labels : {1, 3}) {
      for (const bool one_directional : {false, true}) {
        for (const int chunk : {0, 16}) {
          SCOPED_TRACE("seed " + std::to_string(seed) + ", labels " + std::to_string(labels) + ", chunk " +
                       std::to_string(chunk));
          const Case c = make_case(seed, labels);
          const ChamferDistance distance(c.scan, c.regions, {one_directional, chunk});
          Points3f gradient;
          const double value = distance(c.vertices, gradient, Execution(2));
          const auto truth = [&](const Eigen::VectorXd& change) {
            const Points3d moved =
                c.vertices.cast<double>() + Eigen::Map<const Points3d>(change.data(), 3, 60);
            return Eigen::VectorXd(Eigen::VectorXd::Constant(
                1, chamfer(moved, c.regions.vertices, c.scan, c.regions.scan, labels, one_directional)));
          };
          EXPECT_NEAR(value, truth(Eigen::VectorXd::Zero(180))[0], 1e-6);
          const Eigen::VectorXd flat = Eigen::Map<const Eigen::VectorXf>(gradient.data(), 180).cast<double>();
          testing::expect_jacobian(flat.transpose(), 180, truth, 1e-6, 1e-4);
        }
      }
    }
  }
}

TEST(Chamfer, TreesAndBlocksGiveTheSameBits) {
  const Points3f vertices = cloud(3000, 11), scan = cloud(4000, 12);
  Points3f by_tree, by_blocks;
  const double tree = ChamferDistance(scan, {}, {false, 0})(vertices, by_tree, Execution(2));
  const double blocks = ChamferDistance(scan, {}, {false, 512})(vertices, by_blocks, Execution(2));
  EXPECT_EQ(tree, blocks);
  EXPECT_EQ(by_tree, by_blocks);
}

// Two clusters, each nearer to the other's partner: without regions they are matched crosswise.
TEST(Chamfer, NoPairCrossesRegions) {
  Points3f vertices(3, 2), scan(3, 2);
  vertices << 0, 1, 0, 0, 0, 0;
  scan << 1.1f, -0.1f, 0, 0, 0, 0;  // scan point 0 belongs to vertex 0
  Points3f gradient;
  EXPECT_NEAR(ChamferDistance(scan, {}, {})(vertices, gradient, Execution(1)), 0.2, 1e-6);
  EXPECT_GT(gradient(0, 0), 0) << "away from the point at -0.1";
  const RegionLabels regions{2, {1, 0}, {1, 0}};
  EXPECT_NEAR(ChamferDistance(scan, regions, {})(vertices, gradient, Execution(1)), 4.4, 1e-6);
  EXPECT_LT(gradient(0, 0), 0) << "toward its own partner at 1.1";
  EXPECT_GT(gradient(0, 1), 0);
}

TEST(Chamfer, CoincidingPointsHaveNoGradient) {
  const Points3f points = cloud(20, 4);
  Points3f gradient;
  EXPECT_EQ(ChamferDistance(points, {}, {})(points, gradient, Execution(1)), 0);
  EXPECT_EQ(gradient.cwiseAbs().maxCoeff(), 0);
}

// A label that one side lacks (all of the scan painted) has no term.
TEST(Chamfer, LeftoversWithoutPartnersAreLeftOut) {
  const Points3f vertices = cloud(4, 5), scan = cloud(3, 6);
  const RegionLabels regions{2, {1, 1, 1}, {1, 1, 0, 0}};
  Points3f gradient;
  const double value = ChamferDistance(scan, regions, {})(vertices, gradient, Execution(1));
  Points3f alone;
  EXPECT_EQ(value, ChamferDistance(scan, {}, {})(vertices.leftCols(2), alone, Execution(1)));
  EXPECT_EQ(gradient.rightCols(2).cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace vitruvian
