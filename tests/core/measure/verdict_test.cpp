#include <gtest/gtest.h>

#include <limits>

#include "body/model.h"
#include "measure/verdict_features.h"
#include "measure/verdict_model.h"

namespace vitruvian {
namespace {

/// A right fit of a bare body, as measured on one of suite `poses` in rounded numbers.
VerdictFeatures good() {
  VerdictFeatures f;
  f.model_to_scan_p95_mm = 1.9;
  f.scan_to_model_p95_mm = 1.4;
  f.typical_mm = 15.6;
  f.opposed_share = 0.002;
  f.inside_share = 0.016;
  f.stature_m = 1.64;
  f.limb_misfit = {0.63, 0.68, 0.57, 0.57};
  f.part_model_to_scan_p95_mm.fill(2);
  f.part_scan_to_model_p95_mm.fill(1.5);
  return f;
}

/// A right fit of a clothed avatar with hair.
VerdictFeatures clothed() {
  VerdictFeatures f;
  f.model_to_scan_p95_mm = 14.5;
  f.scan_to_model_p95_mm = 32.8;
  f.typical_mm = 24.6;
  f.unexplained_share = 0.021;
  f.opposed_share = 0.008;
  f.inside_share = 0.003;
  f.stature_m = 1.78;
  f.limb_misfit = {0.57, 0.69, 0.80, 0.76};
  f.joint_limit_excess_rad = {{"spine1", 0.06}, {"right_elbow", 0.02}};
  f.keypoint_disagreement_m = {{"right_elbow", 0.086}, {"right_foot", 0.055}};
  f.part_model_to_scan_p95_mm.fill(11);
  f.part_model_to_scan_p95_mm[23] = 31;
  f.part_scan_to_model_p95_mm.fill(16);
  f.part_scan_to_model_p95_mm[9] = 113;
  f.part_opposed_share[22] = 0.1;
  return f;
}

/// Legs exchanged in place: they cross inside the hips, and lie within the scan all the same.
VerdictFeatures exchanged_legs() {
  VerdictFeatures f = good();
  f.model_to_scan_p95_mm = 17.8;
  f.scan_to_model_p95_mm = 16.9;
  f.typical_mm = 20.4;
  f.unexplained_share = 0.003;
  f.opposed_share = 0.019;
  f.inside_share = 0.1;
  f.limb_misfit = {0.52, 0.52, 0.74, 0.77};
  f.joint_limit_excess_rad = {{"right_hip", 0.09}, {"right_knee", 0.16}};
  f.keypoint_disagreement_m = {{"left_hip", 0.18}, {"right_hip", 0.19}};
  f.part_model_to_scan_p95_mm[0] = 50;
  f.part_model_to_scan_p95_mm[1] = 72;
  f.part_model_to_scan_p95_mm[2] = 67;
  f.part_scan_to_model_p95_mm[1] = 43;
  f.part_opposed_share[5] = 0.07;
  return f;
}

/// Arms on the wrong sides: the trunk turned round, no single number beyond what clothes explain.
VerdictFeatures exchanged_arms() {
  VerdictFeatures f = good();
  f.model_to_scan_p95_mm = 36.6;
  f.scan_to_model_p95_mm = 40.6;
  f.typical_mm = 26;
  f.unexplained_share = 0.025;
  f.opposed_share = 0.025;
  f.inside_share = 0.062;
  f.limb_misfit = {1.3, 0.87, 0.32, 0.31};
  f.joint_limit_excess_rad = {{"left_elbow", 0.45}, {"spine3", 0.32}};
  for (const std::size_t s : {3, 6, 9, 13}) f.observed_share[s] = 0.39;
  f.part_model_to_scan_p95_mm[15] = 60;
  f.part_scan_to_model_p95_mm[13] = 75;
  f.part_opposed_share[22] = 0.28;
  return f;
}

bool mentions(const Verdict& verdict, const std::string& words) {
  for (const std::string& reason : verdict.reasons) {
    if (reason.find(words) != std::string::npos) return true;
  }
  return false;
}

int segment_of(std::string_view name) {
  for (std::size_t s = 0; s < kSegmentNames.size(); ++s) {
    if (kSegmentNames[s] == name) return static_cast<int>(s);
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(Verdict, RightFitsAreOkWithoutReasons) {
  for (const VerdictFeatures& features : {good(), clothed()}) {
    const Verdict verdict = judge(features);
    EXPECT_EQ(verdict.status, VerdictStatus::ok);
    EXPECT_TRUE(verdict.reasons.empty());
    EXPECT_GE(verdict.confidence, confidence_of_ok());
  }
  EXPECT_GT(judge(good()).confidence, 0.99);
  EXPECT_EQ(judge(VerdictFeatures()).status, VerdictStatus::ok) << "defaults speak against nothing";
}

TEST(Verdict, ExchangedLimbsAreDoubtedAndTheirPlaceIsNamed) {
  const Verdict legs = judge(exchanged_legs()), arms = judge(exchanged_arms());
  EXPECT_EQ(legs.status, VerdictStatus::doubtful);
  EXPECT_LT(legs.confidence, confidence_of_ok());
  EXPECT_TRUE(mentions(legs, "left upper leg (72 mm)"));
  EXPECT_NE(arms.status, VerdictStatus::ok);
  EXPECT_LT(arms.confidence, 0.1);
  EXPECT_TRUE(mentions(arms, "head (60 mm)"));
  EXPECT_TRUE(mentions(arms, "left elbow (by 26 degrees)"));
  EXPECT_TRUE(mentions(arms, "hardly seen in the scan, so mostly guessed: spine"));
}

TEST(Verdict, WhatIsDoubtedHasAReasonThatNamesAPart) {
  // Nothing striking by itself.
  VerdictFeatures f = exchanged_legs();
  f.model_to_scan_p95_mm = 14;
  f.typical_mm = 21;
  const Verdict verdict = judge(f);
  ASSERT_EQ(verdict.status, VerdictStatus::doubtful);
  EXPECT_TRUE(mentions(verdict, "left upper leg (72 mm)"));
}

TEST(Verdict, WhatLiesElsewhereFails) {
  VerdictFeatures f = exchanged_arms();
  f.scan_to_model_p95_mm = 300;
  EXPECT_EQ(judge(f).status, VerdictStatus::failed);
  EXPECT_LT(judge(f).confidence, 0.1);
  f = exchanged_arms();
  f.model_to_scan_p95_mm = 80;
  EXPECT_EQ(judge(f).status, VerdictStatus::failed);
  f = clothed();
  f.observed_share.fill(0.1);
  EXPECT_EQ(judge(f).status, VerdictStatus::failed);
  EXPECT_TRUE(mentions(judge(f), "24 of the 24"));
}

TEST(Verdict, ConfidenceNeverRisesAsAFeatureGrowsWorse) {
  for (const VerdictFeatures& from : {good(), clothed(), exchanged_legs()}) {
    const double before = judge(from).confidence;
    for (double VerdictFeatures::*member :
         {&VerdictFeatures::model_to_scan_p95_mm, &VerdictFeatures::scan_to_model_p95_mm,
          &VerdictFeatures::typical_mm, &VerdictFeatures::opposed_share, &VerdictFeatures::unexplained_share,
          &VerdictFeatures::inside_share}) {
      VerdictFeatures f = from;
      f.*member = 4 * f.*member + 0.02;
      EXPECT_LE(judge(f).confidence, before);
    }
    VerdictFeatures f = from;
    f.part_opposed_share[3] = 0.9;
    f.part_model_to_scan_p95_mm[4] = 200;
    f.limb_misfit[1] = 3;
    f.joint_limit_excess_rad = {{"left_knee", 1.5}};
    EXPECT_LT(judge(f).confidence, before);
  }
}

TEST(Verdict, PartsWithoutAScanDoNotSpeakThroughTheirDistances) {
  VerdictFeatures f = clothed();
  f.observed_share[20] = 0.02;
  f.unseen_share[20] = 0.97;
  const double before = calibrated_confidence(f);
  f.part_model_to_scan_p95_mm[20] = 300;
  f.part_opposed_share[20] = 1;
  EXPECT_LT(calibrated_confidence(f), before) << "what little of it can be seen counts";
  f.observed_share[20] = 0.01;
  f.unseen_share[20] = 0.9;
  EXPECT_EQ(calibrated_confidence(f), before) << "but it is not met, and named as guessed";
  EXPECT_TRUE(mentions(judge(f), "not in the scan, so guessed: left hand"));
}

TEST(Verdict, ExtremitiesAreTold) {
  VerdictFeatures f = good();
  f.observed_share[segment_of("right_hand_index")] = 0.3;
  const Verdict verdict = judge(f);
  EXPECT_EQ(verdict.status, VerdictStatus::ok) << "fingers are often missing";
  EXPECT_TRUE(mentions(verdict, "right hand index"));
}

TEST(Verdict, NotesAndStatureAreTold) {
  VerdictFeatures f = good();
  f.notes = {"the unit could be cm or in; cm was taken"};
  Verdict verdict = judge(f);
  EXPECT_EQ(verdict.status, VerdictStatus::ok);
  EXPECT_TRUE(mentions(verdict, "could be cm or in"));
  f.stature_m = 0.7;
  verdict = judge(f);
  EXPECT_EQ(verdict.status, VerdictStatus::doubtful);
  EXPECT_TRUE(mentions(verdict, "0.70 m"));
}

TEST(Verdict, NotANumberFails) {
  VerdictFeatures f = good();
  f.scan_to_model_p95_mm = std::numeric_limits<double>::quiet_NaN();
  const Verdict verdict = judge(f);
  EXPECT_EQ(verdict.status, VerdictStatus::failed);
  EXPECT_EQ(verdict.confidence, 0);
}

TEST(Verdict, FeaturesComeFromTheMeasurement) {
  SurfaceMeasurement m;
  m.sampled_distance_m = {0.001f, 0.002f, 0.051f, 0.2f};
  m.opposed_share = 0.25;
  m.error.scan_to_model.p95_mm = 12;
  m.error.surface_all.p95_mm = 7;
  m.error.surface_segments = {{"hips", 0.4, std::nullopt}};
  m.sampled_vertex = {0, 0, 1, 1};
  m.segment_opposed_share = std::vector<double>(24, 0.125);
  const std::vector<std::uint8_t> segment = {0, 5};
  const VerdictFeatures f = features_from(m, segment);
  EXPECT_NEAR(f.part_scan_to_model_p95_mm[0], 1.95, 1e-4);
  EXPECT_EQ(f.part_unexplained_share[0], 0);
  EXPECT_EQ(f.part_unexplained_share[5], 1);
  EXPECT_EQ(f.part_opposed_share[7], 0.125);
  EXPECT_EQ(f.unexplained_share, 0.5);
  EXPECT_EQ(f.opposed_share, 0.25);
  EXPECT_EQ(f.scan_to_model_p95_mm, 12);
  EXPECT_EQ(f.model_to_scan_p95_mm, 7);
  EXPECT_EQ(f.observed_share[0], 0.4);
  EXPECT_EQ(f.observed_share[1], 1);
}

TEST(Verdict, PartsThatTheScanCannotShowAreNamedAndChangeNothing) {
  VerdictFeatures features;
  features.observed_share[18] = 0.1;
  features.unseen_share[18] = 0.8;
  const Verdict verdict = judge(features);
  EXPECT_EQ(verdict.status, VerdictStatus::ok);
  ASSERT_EQ(verdict.reasons.size(), 1u);
  EXPECT_NE(verdict.reasons[0].find(plain_name(kSegmentNames[18])), std::string::npos);
  EXPECT_GT(verdict.confidence, 0.99);
}

TEST(Verdict, AMisfitHandIsNamed) {
  VerdictFeatures features = exchanged_arms();
  features.misfit_parts = {"left hand"};
  EXPECT_TRUE(mentions(judge(features), "in another part's place: left hand"));
}

TEST(Verdict, DistancesOverAHoleDoNotCount) {
  SurfaceMeasurement measurement;
  std::vector<std::uint8_t> segment(200, 0), unseen(200, 0);
  for (int v = 0; v < 200; ++v) {
    unseen[v] = v < 80 ? 1 : 0;
    measurement.surface_distance_m.push_back(v < 80 ? 0.2f : 0.001f);
  }
  VerdictFeatures features;
  features.model_to_scan_p95_mm = 200;
  features.observed_share[0] = 0.6;
  leave_out_unseen(unseen, segment, measurement, features);
  EXPECT_NEAR(features.model_to_scan_p95_mm, 1, 1e-3);
  EXPECT_NEAR(features.unseen_share[0], 0.4, 1e-9);
  // Without holes nothing changes.
  VerdictFeatures whole;
  whole.model_to_scan_p95_mm = 7;
  leave_out_unseen(std::vector<std::uint8_t>(200, 0), segment, measurement, whole);
  EXPECT_EQ(whole.model_to_scan_p95_mm, 7);
}

}  // namespace
}  // namespace vitruvian
