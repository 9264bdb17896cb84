#include "keypoints/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "keypoints/left_right.h"
#include "keypoints/views.h"
#include "synthetic_person.h"

namespace vitruvian {
namespace {

double worst_error(const std::vector<Landmark3d>& found, const std::vector<Vec3f>& truth) {
  double worst = 0;
  for (int l = 0; l < kLandmarkCount; ++l)
    worst = std::max<double>(worst, (found[l].position - truth[l]).norm());
  return worst;
}

TEST(Triangulation, RecoversExactPoints) {
  const auto truth = standing_person();
  for (const int count : {2, 3, 5, 8, 12, 16}) {
    SCOPED_TRACE(count);
    const auto cameras = ring_of(truth, count == 2 ? 4 : count);
    const std::span<const Camera> used(cameras.data(), static_cast<std::size_t>(count));
    const auto views = seen_by(used, truth);
    const Triangulation result = triangulate(used, views, TriangulationSettings());
    EXPECT_LT(worst_error(result.landmarks, truth), 1e-3);
    for (const Landmark3d& landmark : result.landmarks) {
      EXPECT_NEAR(landmark.confidence, 1, 1e-3);
      EXPECT_LT(landmark.residual, 1e-3);
    }
    for (const auto& group : result.swapped) EXPECT_EQ(std::count(group.begin(), group.end(), 1), 0);
  }
}

TEST(Triangulation, OutvotesOutliers) {
  const auto truth = standing_person();
  const auto cameras = ring_of(truth, 8);
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto views = seen_by(cameras, truth);
    for (auto& view : views) {
      for (auto& landmark : view.landmarks) {
        landmark.pixel += Eigen::Vector2d(random.normal(), random.normal()).cast<float>();
      }
    }
    for (int l = 0; l < kLandmarkCount; ++l) {
      for (int k = 0; k < 2; ++k) {
        views[random.below(8)].landmarks[l].pixel +=
            Eigen::Vector2f(150, static_cast<float>(random.uniform(-200, 200)));
      }
    }
    TriangulationSettings plain;
    plain.find_swaps = false;
    EXPECT_LT(worst_error(triangulate(cameras, views, plain).landmarks, truth), 0.02);
  }
}

TEST(Triangulation, FindsExchangedLimbs) {
  const auto truth = left_arm_raised();
  const auto cameras = ring_of(truth, 8);
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto views = seen_by(cameras, truth);
    std::array<std::vector<std::uint8_t>, kLimbGroupCount> exchanged;
    for (int g = 0; g < kLimbGroupCount; ++g) {
      exchanged[g].assign(8, 0);
      // Views of the back and its neighbours, at most three of eight; side views show no difference.
      for (const int v : {3, 4, 5}) exchanged[g][v] = random.uniform() < 0.6;
      for (int v = 0; v < 8; ++v) {
        if (exchanged[g][v]) exchange_group(views[v], g);
      }
    }
    const Triangulation result = triangulate(cameras, views, TriangulationSettings());
    EXPECT_LT(worst_error(result.landmarks, truth), 0.01);
    for (int g = 0; g < kLimbGroupCount; ++g) {
      for (const int v : {0, 1, 3, 4, 5, 7})
        EXPECT_EQ(result.swapped[g][v], exchanged[g][v]) << g << " " << v;
    }
  }
}

TEST(Triangulation, FindsAnArcOfExchangedViewsAmongSixteen) {
  const auto truth = left_arm_raised();
  const auto cameras = ring_of(truth, 16);
  auto views = seen_by(cameras, truth);
  for (const int v : {6, 7, 8, 9}) {
    for (int g = 0; g < kLimbGroupCount; ++g) exchange_group(views[v], g);
  }
  const Triangulation result = triangulate(cameras, views, TriangulationSettings());
  EXPECT_LT(worst_error(result.landmarks, truth), 0.01);
}

TEST(Triangulation, AnatomyDecidesWhenHalfOfTheViewsExchangeTheLegs) {
  const auto truth = standing_person();
  const auto cameras = ring_of(truth, 8);
  auto views = seen_by(cameras, truth);
  for (const int v : {1, 3, 5, 7}) exchange_group(views[v], static_cast<int>(LimbGroup::legs));
  EXPECT_LT(worst_error(triangulate(cameras, views, TriangulationSettings()).landmarks, truth), 0.01);
  TriangulationSettings plain;
  plain.find_swaps = false;
  EXPECT_GT(worst_error(triangulate(cameras, views, plain).landmarks, truth), 0.05);
}

TEST(Triangulation, VisibilityIsASoftWeightAndAThreshold) {
  const auto truth = standing_person();
  const auto cameras = ring_of(truth, 8);
  auto views = seen_by(cameras, truth);
  for (auto& view : views) view.landmarks[15].visibility = 0.1f;
  for (int v = 0; v < 8; ++v) views[v].landmarks[16].visibility = v < 3 ? 0.2f : 0.9f;
  TriangulationSettings settings;
  const auto soft = triangulate(cameras, views, settings);
  EXPECT_NEAR(soft.landmarks[15].confidence, 0.1, 0.01);
  EXPECT_LT((soft.landmarks[15].position - truth[15]).norm(), 1e-3);
  settings.min_visibility = 0.5;
  const auto hard = triangulate(cameras, views, settings);
  EXPECT_EQ(hard.landmarks[15].confidence, 0);
  EXPECT_GT(hard.landmarks[16].confidence, 0.5);
}

TEST(Triangulation, RaisedLeftArmStaysLeftWithEightViews) {
  const auto truth = left_arm_raised();
  const auto cameras = ring_of(truth, 8);
  auto found = triangulate(cameras, seen_by(cameras, truth), TriangulationSettings()).landmarks;
  EXPECT_EQ(correct_left_right(found), LeftRightFinding::consistent);
  EXPECT_GT(found[15].position.y(), found[16].position.y() + 0.5f);
}

TEST(Triangulation, RefusesWrongSizes) {
  const auto truth = standing_person();
  const auto cameras = ring_of(truth, 4);
  auto views = seen_by(cameras, truth);
  EXPECT_THROW(triangulate(std::span(cameras).first(3), views, TriangulationSettings()), Error);
  EXPECT_THROW(triangulate(std::span(cameras).first(1), std::span(views).first(1), TriangulationSettings()),
               Error);
  views[2].landmarks.pop_back();
  EXPECT_THROW(triangulate(cameras, views, TriangulationSettings()), Error);
}

TEST(TwoViews, LiftIsThePapersFormula) {
  const auto truth = left_arm_raised();
  Points3f points(3, kLandmarkCount);
  for (int l = 0; l < kLandmarkCount; ++l) points.col(l) = truth[l];
  const auto [front, side] = paper_cameras(points, Framing());
  const auto views = seen_by(std::array{front, side}, truth);
  const auto found = lift_two_views(front, views[0], side, views[1], VisibilityRule::mean, 0);
  EXPECT_LT(worst_error(found, truth), 1e-4);
  // The same by hand for the left wrist, canonical frame: z up, y forward, left at smaller x.
  const double half = 0.5 * front.width / front.pixels_per_metre;
  const double x_max = -front.centre.x() + half, u = views[0].landmarks[15].pixel.x() / front.width;
  EXPECT_NEAR(x_max - u * 2 * half, -truth[15].x(), 1e-4);
}

TEST(TwoViews, RaisedLeftArmStaysLeftAfterTheCheck) {
  const auto truth = left_arm_raised();
  Points3f points(3, kLandmarkCount);
  for (int l = 0; l < kLandmarkCount; ++l) points.col(l) = truth[l];
  const auto [front, side] = paper_cameras(points, Framing());
  const auto views = seen_by(std::array{front, side}, truth);
  auto found = lift_two_views(front, views[0], side, views[1], VisibilityRule::mean, 0);
  EXPECT_EQ(correct_left_right(found), LeftRightFinding::consistent);
  EXPECT_GT(found[15].position.x(), 0.1f);
  EXPECT_GT(found[15].position.y(), found[16].position.y() + 0.5f);
}

TEST(TwoViews, VerticalComesFromTheFrontAndVisibilitiesCombine) {
  const auto truth = standing_person();
  Points3f points(3, kLandmarkCount);
  for (int l = 0; l < kLandmarkCount; ++l) points.col(l) = truth[l];
  const std::array<Camera, 2> cameras = paper_cameras(points, Framing());
  auto views = seen_by(cameras, truth);
  views[1].landmarks[0].pixel.y() += 0.1f * cameras[1].pixels_per_metre;
  views[0].landmarks[0].visibility = 0.9f;
  views[1].landmarks[0].visibility = 0.3f;
  const auto lift = [&](VisibilityRule rule, double threshold) {
    return lift_two_views(cameras[0], views[0], cameras[1], views[1], rule, threshold)[0];
  };
  const Landmark3d mean = lift(VisibilityRule::mean, 0.5);
  EXPECT_LT((mean.position - truth[0]).norm(), 1e-4);
  EXPECT_NEAR(mean.residual, 0.1, 1e-4);
  EXPECT_NEAR(mean.confidence, 0.6, 1e-6);
  EXPECT_NEAR(lift(VisibilityRule::minimum, 0).confidence, 0.3, 1e-6);
  EXPECT_NEAR(lift(VisibilityRule::product, 0).confidence, 0.27, 1e-6);
  EXPECT_EQ(lift(VisibilityRule::minimum, 0.5).confidence, 0);
}

}  // namespace
}  // namespace vitruvian
