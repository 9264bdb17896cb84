#include "keypoints/blazepose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/random.h"
#include "keypoints/view_landmarks.h"

namespace vitruvian {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

View make_view(int left, int top, int right, int bottom) {
  View view{};
  view.camera.width = 400;
  view.camera.height = 300;
  view.rgb.assign(3u * 400 * 300, 190);
  view.left = left, view.top = top, view.right = right, view.bottom = bottom;
  return view;
}

float logit(float probability) { return std::log(probability / (1 - probability)); }

/// Outputs that place landmark k at `crop_points[k]`, with flat heatmaps of low probability.
NetworkOutputs outputs_for(const std::vector<Eigen::Vector2f>& crop_points, float presence) {
  NetworkOutputs outputs{std::vector<float>(195, 0.0f), {presence}, std::vector<float>(39 * 64 * 64, -10.0f)};
  for (std::size_t k = 0; k < crop_points.size(); ++k) {
    outputs[0][5 * k] = crop_points[k].x();
    outputs[0][5 * k + 1] = crop_points[k].y();
    outputs[0][5 * k + 3] = logit(0.8f);
    outputs[0][5 * k + 4] = logit(0.9f);
  }
  return outputs;
}

std::vector<Eigen::Vector2f> random_points(Random& random) {
  std::vector<Eigen::Vector2f> points(35);
  for (Eigen::Vector2f& point : points) {
    point = {static_cast<float>(random.uniform(0, 256)), static_cast<float>(random.uniform(0, 256))};
  }
  return points;
}

TEST(RegionFromSilhouette, IsTheEnlargedSquareRoundTheBox) {
  const Region region = region_from_silhouette(make_view(100, 20, 180, 260));
  EXPECT_FLOAT_EQ(region.centre.x(), 140);
  EXPECT_FLOAT_EQ(region.centre.y(), 140);
  EXPECT_FLOAT_EQ(region.size, 300);
  EXPECT_EQ(region.rotation, 0);
}

TEST(RegionFromSilhouette, EmptyViewGivesTheWholeImage) {
  const Region region = region_from_silhouette(make_view(0, 0, 0, 0));
  EXPECT_FLOAT_EQ(region.centre.x(), 200);
  EXPECT_FLOAT_EQ(region.centre.y(), 150);
  EXPECT_FLOAT_EQ(region.size, 400);
}

TEST(RegionFromAuxiliary, TurnsTheCirclePointUp) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    const float turn = static_cast<float>(random.uniform(-kPi, kPi)),
                length = static_cast<float>(random.uniform(20, 90));
    const Eigen::Vector2f hip(200, 150),
        circle = hip + length * Eigen::Vector2f(std::sin(turn), -std::cos(turn));
    const Region region = region_from_auxiliary(hip, circle);
    EXPECT_NEAR(region.size, 2.5f * length, 1e-3f);
    EXPECT_NEAR(std::remainder(region.rotation - turn, 2 * kPi), 0, 1e-4f) << "seed " << seed;
    // The circle point lies 0.4 of the crop's side above its centre.
    EXPECT_LT((region.crop_from_image(circle, 1) - Eigen::Vector2f(0.5f, 0.1f)).norm(), 1e-4f)
        << "seed " << seed;
  }
}

TEST(PlausibleRegion, RefusesTheAbsurd) {
  const View view = make_view(100, 20, 180, 260);
  const Region first = region_from_silhouette(view);
  EXPECT_TRUE(is_plausible_region({{200, 150}, first.size, 3}, first, view));
  EXPECT_FALSE(is_plausible_region({{200, 150}, 0.39f * first.size, 0}, first, view));
  EXPECT_FALSE(is_plausible_region({{200, 150}, 2.51f * first.size, 0}, first, view));
  EXPECT_FALSE(is_plausible_region({{200, 301}, first.size, 0}, first, view));
  EXPECT_FALSE(is_plausible_region({{-1, 150}, first.size, 0}, first, view));
  EXPECT_FALSE(is_plausible_region({{NAN, 150}, first.size, 0}, first, view));
  EXPECT_FALSE(is_plausible_region({{200, 150}, NAN, 0}, first, view));
}

TEST(DecodeLandmarks, UnsureHeatmapsKeepTheRegressedPoint) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const std::vector<Eigen::Vector2f> points = random_points(random);
    const Region region{{190, 160},
                        static_cast<float>(random.uniform(100, 500)),
                        static_cast<float>(random.uniform(-kPi, kPi))};
    const LandmarkReading reading = decode_landmarks(outputs_for(points, 0.75f), region);
    ASSERT_EQ(reading.view.landmarks.size(), 33u);
    EXPECT_EQ(reading.view.body_presence, 0.75f);
    for (std::size_t k = 0; k < 33; ++k) {
      const ViewLandmark& landmark = reading.view.landmarks[k];
      EXPECT_LT((landmark.pixel - region.image_from_crop(points[k], 256)).norm(), 1e-3f) << "seed " << seed;
      EXPECT_NEAR(landmark.visibility, 0.8f, 1e-5f);
      EXPECT_NEAR(landmark.presence, 0.9f, 1e-5f);
    }
    EXPECT_LT((reading.mid_hip - region.image_from_crop(points[33], 256)).norm(), 1e-3f);
    EXPECT_LT((reading.circle_point - region.image_from_crop(points[34], 256)).norm(), 1e-3f);
  }
}

TEST(DecodeLandmarks, SureHeatmapMovesThePointToItsCentroid) {
  const Region identity{{128, 128}, 256, 0};
  std::vector<Eigen::Vector2f> points(35, Eigen::Vector2f(100, 60));
  NetworkOutputs outputs = outputs_for(points, 1);
  const auto cell = [&](std::size_t k, int row, int column) -> float& {
    return outputs[2][k * 64 * 64 + static_cast<std::size_t>(row * 64 + column)];
  };
  // Everything else all but impossible, so that the centroid is that of the cells set here.
  for (float& value : outputs[2]) value = -30;
  cell(3, 16, 27) = logit(0.6f);  // within 7 x 7 of (25, 15)
  cell(3, 14, 24) = logit(0.2f);
  cell(4, 15, 29) = logit(0.9f);   // one column too far
  cell(5, 15, 26) = logit(0.49f);  // not sure enough
  const LandmarkReading reading = decode_landmarks(outputs, identity);
  const Eigen::Vector2f expected = 4 * Eigen::Vector2f(0.6f * 27 + 0.2f * 24, 0.6f * 16 + 0.2f * 14) / 0.8f;
  EXPECT_LT((reading.view.landmarks[3].pixel - expected).norm(), 1e-3f);
  for (const std::size_t k : {0u, 4u, 5u}) {
    EXPECT_LT((reading.view.landmarks[k].pixel - Eigen::Vector2f(100, 60)).norm(), 1e-3f) << k;
  }
}

TEST(DecodeLandmarks, RefinementStopsAtTheCropsBorder) {
  const Region identity{{128, 128}, 256, 0};
  std::vector<Eigen::Vector2f> points(35, Eigen::Vector2f(128, 128));
  points[0] = {0.5f, 255.5f};
  points[1] = {-30, 100};
  points[2] = {1e20f, -1e20f};
  NetworkOutputs outputs = outputs_for(points, 1);
  for (float& value : outputs[2]) value = 10;
  const LandmarkReading reading = decode_landmarks(outputs, identity);
  // Row 63, column 0: the window holds rows 60..63 and columns 0..3.
  EXPECT_LT((reading.view.landmarks[0].pixel - 4 * Eigen::Vector2f(1.5f, 61.5f)).norm(), 1e-2f);
  EXPECT_EQ(reading.view.landmarks[1].pixel, Eigen::Vector2f(-30, 100));
  EXPECT_TRUE(reading.view.landmarks[2].pixel.allFinite());
}

TEST(ViewLandmarkDetector, LooksTwiceAndKeepsTheSecond) {
  const std::vector<View> views{make_view(100, 20, 180, 260), make_view(50, 50, 350, 250)};
  ViewLandmarkDetector detector(views);
  EXPECT_THROW(detector.result(), Error);

  // First look: view 0 asks for a turned region, view 1 for one that is absurdly small.
  std::vector<Eigen::Vector2f> good(35, Eigen::Vector2f(128, 128)), absurd(35, Eigen::Vector2f(140, 100));
  good[34] = {228, 128};
  absurd[34] = {141, 100};
  std::optional<NetworkRequest> request = detector.next_request();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->network, Network::landmarks);
  ASSERT_EQ(request->inputs.size(), 2u);
  for (const auto& input : request->inputs) EXPECT_EQ(input.size(), 3u * 256 * 256);
  detector.accept({{outputs_for(good, 0.9f), outputs_for(absurd, 0.9f)}});

  request = detector.next_request();
  ASSERT_TRUE(request);
  ASSERT_EQ(request->inputs.size(), 1u) << "the absurd region must not be looked at";
  std::vector<Eigen::Vector2f> second(35, Eigen::Vector2f(128, 28));
  detector.accept({{outputs_for(second, 0.5f)}});
  EXPECT_FALSE(detector.next_request());

  const std::vector<ViewLandmarks>& result = detector.result();
  ASSERT_EQ(result.size(), 2u);
  // First region: centre (140, 140), side 300; the second is turned by 90 degrees with radius 100 / 256 *
  // 300.
  const float side = 2.5f * 100 * 300 / 256;
  EXPECT_LT((result[0].landmarks[7].pixel - Eigen::Vector2f(140 + 100 * side / 256, 140)).norm(), 1e-2f);
  EXPECT_EQ(result[0].body_presence, 0.5f);
  const Region first = region_from_silhouette(views[1]);
  EXPECT_LT((result[1].landmarks[7].pixel - first.image_from_crop({140, 100}, 256)).norm(), 1e-2f);
  EXPECT_THROW(detector.accept({}), Error);
}

TEST(ViewLandmarkDetector, OneLookAndNoViews) {
  const std::vector<View> views{make_view(100, 20, 180, 260)};
  std::vector<Eigen::Vector2f> points(35, Eigen::Vector2f(128, 128));
  points[34] = {128, 28};
  ViewLandmarkDetector once(views, false);
  once.accept({{outputs_for(points, 0.9f)}});
  EXPECT_FALSE(once.next_request());
  EXPECT_EQ(once.result().size(), 1u);

  ViewLandmarkDetector none(std::span<const View>{});
  EXPECT_FALSE(none.next_request());
  EXPECT_TRUE(none.result().empty());
}

TEST(ViewLandmarkDetector, RefusesAReplyThatDoesNotFit) {
  const std::vector<View> views{make_view(100, 20, 180, 260)};
  ViewLandmarkDetector detector(views);
  EXPECT_THROW(detector.accept({}), Error);
  NetworkOutputs outputs = outputs_for(std::vector<Eigen::Vector2f>(35, Eigen::Vector2f(1, 1)), 0.5f);
  outputs[0][0] = NAN;
  EXPECT_THROW(detector.accept({{outputs}}), Error);
  EXPECT_TRUE(detector.next_request()) << "a refused reply leaves the request open";
}

}  // namespace
}  // namespace vitruvian
