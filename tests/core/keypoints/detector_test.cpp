#include "keypoints/detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vitruvian {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

View make_view(int width, int height) {
  View view{};
  view.camera.width = width;
  view.camera.height = height;
  view.rgb.assign(static_cast<std::size_t>(3) * width * height, 10);
  return view;
}

NetworkOutputs nobody() { return {std::vector<float>(2254 * 12, 0.0f), std::vector<float>(2254, -20.0f)}; }

/// Writes a body into one anchor; positions in units of the input's side.
void put(NetworkOutputs& outputs, std::size_t anchor, float logit, const Eigen::Vector2f& box_centre,
         float box_size, const Eigen::Vector2f& hip, const Eigen::Vector2f& circle) {
  const Eigen::Vector2f origin = detector_anchors()[anchor];
  float* values = outputs[0].data() + 12 * anchor;
  const auto write = [&](std::size_t first, const Eigen::Vector2f& point) {
    values[first] = 224 * (point.x() - origin.x());
    values[first + 1] = 224 * (point.y() - origin.y());
  };
  write(0, box_centre);
  values[2] = values[3] = 224 * box_size;
  write(4, hip);
  write(6, circle);
  write(8, hip);
  write(10, circle);
  outputs[1][anchor] = logit;
}

TEST(DetectorAnchors, ThreeGridsInOrder) {
  const std::vector<Eigen::Vector2f> anchors = detector_anchors();
  ASSERT_EQ(anchors.size(), 2254u);
  EXPECT_LT((anchors[0] - Eigen::Vector2f(0.5f / 28, 0.5f / 28)).norm(), 1e-6f);
  EXPECT_EQ(anchors[0], anchors[1]);
  EXPECT_LT((anchors[2] - Eigen::Vector2f(1.5f / 28, 0.5f / 28)).norm(), 1e-6f);
  EXPECT_LT((anchors[28 * 28 * 2] - Eigen::Vector2f(0.5f / 14, 0.5f / 14)).norm(), 1e-6f);
  EXPECT_LT((anchors[28 * 28 * 2 + 14 * 14 * 2] - Eigen::Vector2f(0.5f / 7, 0.5f / 7)).norm(), 1e-6f);
  EXPECT_LT((anchors[2253] - Eigen::Vector2f(6.5f / 7, 6.5f / 7)).norm(), 1e-6f);
}

TEST(DetectorInput, LetterboxesWithTheBackground) {
  const std::vector<float> tensor = detector_input(make_view(448, 224));
  ASSERT_EQ(tensor.size(), 3u * 224 * 224);
  EXPECT_NEAR(tensor[0], 190 / 127.5f - 1, 1e-5f);
  EXPECT_NEAR(tensor[112 * 224 + 112], 10 / 127.5f - 1, 1e-5f);
  EXPECT_NEAR(tensor[223 * 224 + 5], 190 / 127.5f - 1, 1e-5f);
}

TEST(DecodeDetections, NobodyIsNobody) {
  EXPECT_TRUE(decode_detections(nobody(), make_view(100, 100)).empty());
  EXPECT_FALSE(decode_detection(nobody(), make_view(100, 100)));
}

TEST(DecodeDetections, UndoesTheLetterbox) {
  NetworkOutputs outputs = nobody();
  put(outputs, 1000, 3.0f, {0.5f, 0.4f}, 0.2f, {0.5f, 0.5f}, {0.5f, 0.3f});
  const View view = make_view(400, 200);
  const std::optional<Detection> detection = decode_detection(outputs, view);
  ASSERT_TRUE(detection);
  EXPECT_NEAR(detection->score, 1 / (1 + std::exp(-3.0f)), 1e-6f);
  EXPECT_LT((detection->keypoints[0] - Eigen::Vector2f(200, 100)).norm(), 1e-2f);
  EXPECT_LT((detection->keypoints[1] - Eigen::Vector2f(200, 20)).norm(), 1e-2f);
  EXPECT_LT((detection->box_centre - Eigen::Vector2f(200, 60)).norm(), 1e-2f);
  EXPECT_LT((detection->box_size - Eigen::Vector2f(80, 80)).norm(), 1e-2f);
  EXPECT_NEAR(detection->roll, 0, 1e-4f);
}

TEST(DecodeDetections, RollIsClockwiseFromUp) {
  for (int step = -7; step <= 8; ++step) {
    const float roll = static_cast<float>(step) * kPi / 8;
    NetworkOutputs outputs = nobody();
    put(outputs, 7, 5.0f, {0.5f, 0.5f}, 0.2f, {0.5f, 0.5f},
        Eigen::Vector2f(0.5f + 0.3f * std::sin(roll), 0.5f - 0.3f * std::cos(roll)));
    const std::optional<Detection> detection = decode_detection(outputs, make_view(224, 224));
    ASSERT_TRUE(detection);
    EXPECT_NEAR(std::remainder(detection->roll - roll, 2 * kPi), 0, 1e-4f);
  }
}

TEST(DecodeDetections, OverlappingAnchorsAreMergedByScore) {
  NetworkOutputs outputs = nobody();
  put(outputs, 500, 2.0f, {0.50f, 0.5f}, 0.2f, {0.50f, 0.6f}, {0.5f, 0.2f});
  put(outputs, 501, 1.0f, {0.52f, 0.5f}, 0.2f, {0.54f, 0.6f}, {0.5f, 0.2f});
  put(outputs, 2000, 0.5f, {0.10f, 0.1f}, 0.2f, {0.10f, 0.2f}, {0.1f, 0.1f});
  put(outputs, 2001, -0.1f, {0.9f, 0.9f}, 0.2f, {0.9f, 0.9f}, {0.9f, 0.8f});
  const std::vector<Detection> detections = decode_detections(outputs, make_view(224, 224));
  ASSERT_EQ(detections.size(), 2u);
  const float a = 1 / (1 + std::exp(-2.0f)), b = 1 / (1 + std::exp(-1.0f));
  EXPECT_NEAR(detections[0].score, a, 1e-6f);
  EXPECT_NEAR(detections[0].keypoints[0].x(), 224 * (a * 0.50f + b * 0.54f) / (a + b), 1e-2f);
  EXPECT_NEAR(detections[0].box_centre.x(), 224 * (a * 0.50f + b * 0.52f) / (a + b), 1e-2f);
  EXPECT_NEAR(detections[1].box_centre.x(), 22.4f, 1e-2f);
}

TEST(DecodeDetections, DegenerateBoxesEnd) {
  NetworkOutputs outputs = nobody();
  for (std::size_t anchor = 0; anchor < 50; ++anchor) {
    put(outputs, anchor, 30.0f, {0.5f, 0.5f}, anchor % 2 ? 0.0f : -0.1f, {0.5f, 0.5f}, {0.5f, 0.5f});
  }
  outputs[1][60] = 1e30f;
  outputs[1][61] = -1e30f;
  EXPECT_GE(decode_detections(outputs, make_view(224, 224)).size(), 1u);
}

}  // namespace
}  // namespace vitruvian
