#include "measure/correspondence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/random.h"

namespace vitruvian {
namespace {

Points3f random_points(Random& random, Index count, double low, double high) {
  Points3f points(3, count);
  for (Index i = 0; i < points.size(); ++i) points(i) = static_cast<float>(random.uniform(low, high));
  return points;
}

/// The paper's dense rematching, word by word.
std::vector<int> literal_dense(const Points3f& vertices, const Points3f& points) {
  const float h = vertices.row(1).maxCoeff() - vertices.row(1).minCoeff();
  std::vector<bool> assigned(static_cast<std::size_t>(points.cols()));
  std::vector<int> matches;
  for (Index j = 0; j < vertices.cols(); ++j) {
    int best = -1;
    float r = h * (1.0f / 50.0f);
    for (int search = 0; search < 6 && best < 0; ++search, r *= 1.5f) {
      float best_squared = 0;
      for (Index i = 0; i < points.cols(); ++i) {
        const Vec3f d = points.col(i) - vertices.col(j);
        if (assigned[i] || (search < 5 && d.cwiseAbs().maxCoeff() > r)) continue;
        if (best < 0 || d.squaredNorm() < best_squared) {
          best = static_cast<int>(i);
          best_squared = d.squaredNorm();
        }
      }
    }
    assigned[best] = true;
    matches.push_back(best);
  }
  return matches;
}

TEST(Correspondence, DenseIsThePapersRuleWordByWord) {
  const Execution execution(1);
  for (const std::uint32_t seed : {11u, 12u, 13u, 14u}) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Points3f vertices = random_points(random, 300, 0, 1);
    // The points fill only a part of the space and are few, so that boxes grow and run empty.
    const Points3f points = random_points(random, 400, 0, seed % 2 ? 0.5 : 1.0);
    const std::vector<int> matches = match_dense(vertices, points, execution);
    EXPECT_EQ(matches, literal_dense(vertices, points));
    EXPECT_EQ(std::set<int>(matches.begin(), matches.end()).size(), matches.size()) << "not injective";
  }
}

TEST(Correspondence, BoxComesBeforeDistance) {
  // Height 5 gives a box of 0.1. The point at the box's corner (0.13 away) wins over the nearer one outside
  // the box.
  Points3f vertices(3, 2);
  vertices << 0, 0, 0, 5, 0, 0;
  Points3f points(3, 3);
  points.col(0) = Vec3f(0.12f, 0, 0);
  points.col(1) = Vec3f(0.09f, 0.09f, 0.03f);
  points.col(2) = Vec3f(0, 5, 0);
  EXPECT_EQ(match_dense(vertices, points, Execution(1)), (std::vector<int>{1, 2}));
}

TEST(Correspondence, SparseSharesPoints) {
  Points3f vertices(3, 3);
  vertices << 0, 0.1f, 0.2f, 0, 0, 0, 0, 0, 0;
  Points3f points(3, 2);
  points << 0.1f, 9, 0, 0, 0, 0;
  const KdTree tree(points);
  EXPECT_EQ(match_sparse(vertices, tree, Execution(2)), (std::vector<int>{0, 0, 0}));
}

TEST(Correspondence, ModeFollowsThePapersThreshold) {
  EXPECT_EQ(choose_rematching(6890, 30000), Rematching::sparse);
  EXPECT_EQ(choose_rematching(6890, 30001), Rematching::dense);
  EXPECT_EQ(choose_rematching(50000, 40000), Rematching::sparse) << "too few points for one each";
}

TEST(Correspondence, RematchIsTheSameWithAnyThreadCount) {
  Random random(15);
  const Points3f vertices = random_points(random, 3000, 0, 1);
  const Points3f few = random_points(random, 5000, 0, 1), many = random_points(random, 31000, 0, 1);
  for (const Points3f* points : {&few, &many}) {
    const KdTree tree(*points);
    EXPECT_EQ(rematch(vertices, *points, tree, Execution(1)), rematch(vertices, *points, tree, Execution(3)));
  }
}

TEST(Correspondence, RefusesWhatCannotBeMatched) {
  const Execution execution(1);
  EXPECT_THROW(match_dense(Points3f::Zero(3, 3), Points3f::Zero(3, 2), execution), Error);
  Points3f broken = Points3f::Zero(3, 1);
  broken(0) = std::nanf("");
  EXPECT_THROW(match_dense(broken, Points3f::Zero(3, 2), execution), Error);
}

TEST(Correspondence, Cancels) {
  Execution execution(1);
  execution.cancel();
  EXPECT_THROW(match_dense(Points3f::Zero(3, 1), Points3f::Zero(3, 2), execution), Error);
}

}  // namespace
}  // namespace vitruvian
