#include "keypoints/landmark_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

constexpr int kMirror[] = {0,  2,  1,  3,  5,  4,  6,  8,  7,  9,  11, 10,
                           12, 14, 13, 15, 17, 16, 19, 18, 21, 20, 23, 22};

Mat3d random_rotation(Random& random) {
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized()
      .toRotationMatrix();
}

/// True offsets: left ones random, right ones their mirror images.
std::vector<LandmarkOffset> true_offsets(Random& random) {
  const int landmarks[][3] = {{7, 15, 15},  {11, 16, 9},  {13, 18, 16}, {15, 20, 20},
                              {17, 20, 22}, {19, 20, 20}, {23, 1, 0},   {25, 4, 1},
                              {27, 7, 7},   {29, 7, 7},   {31, 10, 7}};
  std::vector<LandmarkOffset> offsets{{0, 15, 15, {0, 0.03, 0.12}, 1}};
  for (const auto& [landmark, joint, frame] : landmarks) {
    const Vec3d offset(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
    offsets.push_back({landmark, joint, frame, offset, 1});
    offsets.push_back(
        {landmark + 1, kMirror[joint], kMirror[frame], offset.cwiseProduct(Vec3d(-1, 1, 1)), 1});
  }
  return offsets;
}

std::vector<CalibrationBody> bodies_with(const std::vector<LandmarkOffset>& offsets, Random& random,
                                         int count, double noise, double outliers) {
  std::vector<CalibrationBody> bodies;
  for (int b = 0; b < count; ++b) {
    CalibrationBody body;
    body.joints = Points3d::Random(3, 24);
    for (int j = 0; j < 24; ++j) body.rotations.push_back(random_rotation(random));
    body.landmarks.assign(kLandmarkCount, {Vec3f::Zero(), 0.0f, 0.0f});
    for (const LandmarkOffset& offset : offsets) {
      Vec3d position = body.joints.col(offset.joint) + body.rotations[offset.frame_joint] * offset.offset;
      position += noise * Vec3d(random.normal(), random.normal(), random.normal());
      if (random.uniform() < outliers) position += Vec3d(0.4, -0.3, 0.5);
      body.landmarks[offset.landmark] = {position.cast<float>(), 0.9f, 0.01f};
    }
    bodies.push_back(body);
  }
  return bodies;
}

TEST(LandmarkCalibration, FindsOffsetsAndFrames) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto truth = true_offsets(random);
    const Calibration found = calibrate_landmarks(bodies_with(truth, random, 24, 0.004, 0.1));
    ASSERT_EQ(found.offsets.size(), 23u);
    ASSERT_EQ(found.residuals.size(), 23u);
    for (const LandmarkOffset& expected : truth) {
      const auto entry =
          std::find_if(found.offsets.begin(), found.offsets.end(),
                       [&](const LandmarkOffset& offset) { return offset.landmark == expected.landmark; });
      ASSERT_NE(entry, found.offsets.end());
      EXPECT_EQ(entry->joint, expected.joint);
      EXPECT_EQ(entry->frame_joint, expected.frame_joint) << expected.landmark;
      EXPECT_LT((entry->offset - expected.offset).norm(), 0.004) << expected.landmark;
      EXPECT_GT(entry->weight, 0);
    }
    for (const CalibrationResidual& residual : found.residuals) EXPECT_LT(residual.median, 0.012);
  }
}

TEST(LandmarkCalibration, RightIsTheMirrorOfLeft) {
  Random random(9);
  const auto offsets = calibrate_landmarks(bodies_with(true_offsets(random), random, 10, 0.03, 0)).offsets;
  for (std::size_t k = 1; k + 1 < offsets.size(); k += 2) {
    EXPECT_EQ(offsets[k].landmark + 1, offsets[k + 1].landmark);
    EXPECT_EQ(kMirror[offsets[k].frame_joint], offsets[k + 1].frame_joint);
    EXPECT_EQ(offsets[k + 1].offset, Vec3d(offsets[k].offset.cwiseProduct(Vec3d(-1, 1, 1))));
    EXPECT_EQ(offsets[k].weight, offsets[k + 1].weight);
  }
  EXPECT_EQ(offsets[0].offset.x(), 0);
}

TEST(LandmarkCalibration, RefusesBodiesThatLackSomething) {
  EXPECT_THROW(calibrate_landmarks({}), Error);
  Random random(1);
  auto bodies = bodies_with(true_offsets(random), random, 2, 0, 0);
  bodies[1].rotations.pop_back();
  EXPECT_THROW(calibrate_landmarks(bodies), Error);
}

TEST(LandmarkCalibration, TextRoundTrip) {
  Random random(4);
  const auto offsets = true_offsets(random);
  const auto again = landmarks_from_json(landmarks_to_json(offsets), "landmarks.json");
  ASSERT_EQ(again.size(), offsets.size());
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    EXPECT_EQ(again[k].landmark, offsets[k].landmark);
    EXPECT_EQ(again[k].joint, offsets[k].joint);
    EXPECT_EQ(again[k].frame_joint, offsets[k].frame_joint);
    EXPECT_EQ(again[k].offset, offsets[k].offset);
    EXPECT_EQ(again[k].weight, offsets[k].weight);
  }
}

TEST(LandmarkCalibration, DamagedTextIsRefusedByName) {
  const char* good =
      R"({"landmarks":[{"landmark":1,"joint":2,"frame_joint":3,"offset_m":[0,0.1,0],"weight":1}]})";
  EXPECT_EQ(landmarks_from_json(good, "x").size(), 1u);
  for (const char* bad :
       {"", "[]", "{}", R"({"landmarks":[]})", R"({"landmarks":[3]})",
        R"({"landmarks":[{"landmark":33,"joint":2,"frame_joint":3,"offset_m":[0,0,0],"weight":1}]})",
        R"({"landmarks":[{"landmark":1.5,"joint":2,"frame_joint":3,"offset_m":[0,0,0],"weight":1}]})",
        R"({"landmarks":[{"landmark":1,"joint":-1,"frame_joint":3,"offset_m":[0,0,0],"weight":1}]})",
        R"({"landmarks":[{"landmark":1,"joint":2,"frame_joint":3,"offset_m":[0,0],"weight":1}]})",
        R"({"landmarks":[{"landmark":1,"joint":2,"frame_joint":3,"offset_m":[0,0,9],"weight":1}]})",
        R"({"landmarks":[{"landmark":1,"joint":2,"frame_joint":3,"offset_m":[0,0,0]}]})",
        R"({"landmarks":[{"landmark":1,"joint":2,"frame_joint":3,"offset_m":[0,0,0],"weight":"1"}]})"}) {
    try {
      landmarks_from_json(bad, "models/landmarks.json");
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_model) << bad;
      EXPECT_NE(std::string(error.what()).find("models/landmarks.json"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace vitruvian
