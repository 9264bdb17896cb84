#include "geometry/kdtree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "base/random.h"

namespace vitruvian {
namespace {

Points3f random_points(Random& random, Index count) {
  Points3f points(3, count);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] = static_cast<float>(random.normal());
  return points;
}

Points3f random_directions(Random& random, Index count) {
  return random_points(random, count).colwise().normalized();
}

Vec3f random_query(Random& random) {
  // A few lie far outside of the cloud.
  const double scale = random.below(5) == 0 ? 100 : 1.5;
  return Vec3d(scale * random.normal(), scale * random.normal(), scale * random.normal()).cast<float>();
}

std::vector<int> all_columns(const Points3f& points) {
  std::vector<int> columns(points.cols());
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

std::vector<int> random_subset(Random& random, Index count) {
  std::vector<int> subset;
  for (int i = 0; i < count; ++i) {
    if (random.below(3) == 0) subset.push_back(i);
  }
  if (subset.empty()) subset.push_back(0);
  for (std::size_t i = subset.size() - 1; i > 0; --i) {
    std::swap(subset[i], subset[random.below(static_cast<std::uint32_t>(i + 1))]);
  }
  return subset;
}

/// Squared distances of the given columns to the query, ascending.
std::vector<Neighbour> brute_force(const Points3f& points, const std::vector<int>& columns,
                                   const Vec3f& query) {
  std::vector<Neighbour> all;
  for (const int column : columns) all.push_back({column, (points.col(column) - query).squaredNorm()});
  std::sort(all.begin(), all.end(),
            [](const Neighbour& a, const Neighbour& b) { return a.squared_distance < b.squared_distance; });
  return all;
}

class KdTreeTest : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(KdTreeTest, NearestIsTheOneOfBruteForce) {
  Random random(GetParam());
  const Points3f points = random_points(random, 1 + random.below(800));
  const std::vector<int> subset = random_subset(random, points.cols());
  const KdTree whole(points), part(points, subset);
  EXPECT_EQ(whole.dimension(), 3);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3f query = random_query(random);
    for (const bool use_subset : {false, true}) {
      const Neighbour found = (use_subset ? part : whole).nearest(query);
      const Neighbour truth = brute_force(points, use_subset ? subset : all_columns(points), query).front();
      EXPECT_FLOAT_EQ(found.squared_distance, truth.squared_distance);
      ASSERT_TRUE(found.index >= 0 && found.index < points.cols());
      EXPECT_FLOAT_EQ((points.col(found.index) - query).squaredNorm(), truth.squared_distance);
      if (use_subset) {
        EXPECT_TRUE(std::find(subset.begin(), subset.end(), found.index) != subset.end());
      }
    }
  }
}

TEST_P(KdTreeTest, NearestByPositionAndNormalIsTheOneOfBruteForce) {
  Random random(GetParam() + 1000);
  const Points3f points = random_points(random, 1 + random.below(800));
  const Points3f normals = random_directions(random, points.cols());
  const float lambda = static_cast<float>(random.uniform(0.05, 2));
  const std::vector<int> subset = random_subset(random, points.cols());
  const KdTree whole(points, normals, lambda), part(points, normals, lambda, subset);
  EXPECT_EQ(whole.dimension(), 6);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3f query = random_query(random), normal = random_directions(random, 1);
    for (const bool use_subset : {false, true}) {
      const auto squared = [&](int i) {
        return (points.col(i) - query).squaredNorm() +
               lambda * lambda * (normals.col(i) - normal).squaredNorm();
      };
      float truth = std::numeric_limits<float>::max();
      for (const int i : use_subset ? subset : all_columns(points)) truth = std::min(truth, squared(i));
      const Neighbour found = (use_subset ? part : whole).nearest(query, normal);
      EXPECT_NEAR(found.squared_distance, truth, 1e-5f * (1 + truth));
      EXPECT_NEAR(squared(found.index), truth, 1e-5f * (1 + truth));
    }
  }
}

TEST_P(KdTreeTest, TheNearestOnesComeInOrder) {
  Random random(GetParam() + 2000);
  const Points3f points = random_points(random, 1 + random.below(300));
  const std::vector<int> subset = random_subset(random, points.cols());
  const KdTree part(points, subset);
  std::vector<Neighbour> found;
  for (int trial = 0; trial < 30; ++trial) {
    const Vec3f query = random_query(random);
    const int count = static_cast<int>(1 + random.below(40));
    part.nearest(query, count, found);
    const std::vector<Neighbour> truth = brute_force(points, subset, query);
    ASSERT_EQ(found.size(), std::min<std::size_t>(count, subset.size()));
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_FLOAT_EQ(found[i].squared_distance, truth[i].squared_distance);
      EXPECT_FLOAT_EQ((points.col(found[i].index) - query).squaredNorm(), truth[i].squared_distance);
    }
  }
}

TEST_P(KdTreeTest, WithinGivesExactlyTheBall) {
  Random random(GetParam() + 3000);
  const Points3f points = random_points(random, 1 + random.below(500));
  const std::vector<int> subset = random_subset(random, points.cols());
  const KdTree part(points, subset);
  std::vector<Neighbour> found, again;
  for (int trial = 0; trial < 30; ++trial) {
    const Vec3f query = random_query(random);
    const float radius = static_cast<float>(random.uniform(0, 2));
    part.within(query, radius, found);
    std::vector<int> indices, truth;
    for (const Neighbour& n : found) {
      indices.push_back(n.index);
      EXPECT_FLOAT_EQ(n.squared_distance, (points.col(n.index) - query).squaredNorm());
    }
    for (const Neighbour& n : brute_force(points, subset, query)) {
      if (n.squared_distance < radius * radius) truth.push_back(n.index);
    }
    std::sort(indices.begin(), indices.end());
    std::sort(truth.begin(), truth.end());
    EXPECT_EQ(indices, truth);

    part.within(query, radius, again);
    ASSERT_EQ(again.size(), found.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(again[i].index, found[i].index);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, KdTreeTest, ::testing::Range(1u, 13u));

TEST(KdTree, EqualPointsAreAllFound) {
  Points3f points(3, 500);
  points.colwise() = Vec3f(1, 2, 3);
  const KdTree tree(points), six(points, points, 0.1f);
  EXPECT_EQ(tree.nearest(Vec3f(1, 2, 4)).squared_distance, 1);
  EXPECT_EQ(six.nearest(Vec3f(1, 2, 4), Vec3f(1, 2, 3)).squared_distance, 1);
  std::vector<Neighbour> found;
  tree.nearest(Vec3f(1, 2, 3), 500, found);
  std::vector<int> indices;
  for (const Neighbour& n : found) indices.push_back(n.index);
  std::sort(indices.begin(), indices.end());
  EXPECT_EQ(indices, all_columns(points));
  tree.within(Vec3f(1, 2, 3), 0.01f, found);
  EXPECT_EQ(found.size(), 500u);
}

TEST(KdTree, NormalsPartTheTwoSidesOfAThinSheet) {
  Points3f points(3, 2), normals(3, 2);
  points << 0, 0, 0, 0, 0, -0.01f;
  normals << 0, 0, 0, 0, 1, -1;
  const Vec3f query(0, 0, -0.008f);
  EXPECT_EQ(KdTree(points).nearest(query).index, 1);
  EXPECT_EQ(KdTree(points, normals, 0.05f).nearest(query, Vec3f::UnitZ()).index, 0);
  EXPECT_EQ(KdTree(points, normals, 0.05f).nearest(query, -Vec3f::UnitZ()).index, 1);
}

TEST(KdTree, EmptyTreesFindNothing) {
  std::vector<Neighbour> found(3);
  const KdTree none, of_nothing(Points3f(3, 0)), six_of_nothing(Points3f(3, 0), Points3f(3, 0), 1);
  for (const KdTree* tree : {&none, &of_nothing, &six_of_nothing}) {
    EXPECT_TRUE(tree->empty());
    tree->nearest(Vec3f::Zero(), 5, found);
    EXPECT_TRUE(found.empty());
    tree->within(Vec3f::Zero(), 5, found);
    EXPECT_TRUE(found.empty());
  }
}

TEST(KdTree, KeepsItsOwnCopyWhenMoved) {
  KdTree moved;
  {
    const Points3f points = Points3f::Identity(3, 3);
    KdTree tree(points);
    moved = std::move(tree);
  }
  EXPECT_FALSE(moved.empty());
  EXPECT_EQ(moved.nearest(Vec3f(0, 5, 0)).index, 1);
}

}  // namespace
}  // namespace vitruvian
