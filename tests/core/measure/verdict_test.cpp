#include <gtest/gtest.h>

#include <limits>

#include "body/model.h"
#include "measure/verdict_features.h"

namespace vitruvian {
namespace {

/// A right fit of a bare body (medians of notes on fits with known joints).
VerdictFeatures good() {
  VerdictFeatures f;
  f.model_to_scan_p95_mm = 9.6;
  f.scan_to_model_p95_mm = 16.8;
  f.opposed_share = 0.01;
  f.stature_m = 1.7;
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

TEST(Verdict, RightFitIsOkWithoutReasons) {
  const Verdict verdict = judge(good());
  EXPECT_EQ(verdict.status, VerdictStatus::ok);
  EXPECT_TRUE(verdict.reasons.empty());
  EXPECT_GT(verdict.confidence, 0.9);
  EXPECT_EQ(judge(VerdictFeatures()).status, VerdictStatus::ok) << "defaults speak against nothing";
}

TEST(Verdict, ResidualsOfEitherDirectionDoubtThenFail) {
  VerdictFeatures f = good();
  f.scan_to_model_p95_mm = 46;
  EXPECT_EQ(judge(f).status, VerdictStatus::doubtful);
  f.scan_to_model_p95_mm = 300;
  EXPECT_EQ(judge(f).status, VerdictStatus::failed);
  EXPECT_LT(judge(f).confidence, 0.1);
  f = good();
  f.model_to_scan_p95_mm = 26;
  EXPECT_EQ(judge(f).status, VerdictStatus::doubtful);
  f.model_to_scan_p95_mm = 80;
  EXPECT_EQ(judge(f).status, VerdictStatus::failed);
}

TEST(Verdict, ConfidenceFallsAsAnyFeatureGrowsWorse) {
  for (double VerdictFeatures::*member :
       {&VerdictFeatures::model_to_scan_p95_mm, &VerdictFeatures::scan_to_model_p95_mm,
        &VerdictFeatures::opposed_share, &VerdictFeatures::unexplained_share,
        &VerdictFeatures::inside_share}) {
    VerdictFeatures f = good();
    const double before = judge(f).confidence;
    f.*member = 4 * f.*member + 0.02;
    EXPECT_LT(judge(f).confidence, before);
  }
}

TEST(Verdict, OpposedNormalsCountForBareScansOnly) {
  VerdictFeatures f = good();
  f.opposed_share = 0.038;
  EXPECT_EQ(judge(f).status, VerdictStatus::doubtful);
  f.scan_to_model_p95_mm = 40;
  EXPECT_EQ(judge(f).status, VerdictStatus::ok) << "clothes";
}

TEST(Verdict, UnseenPartsAreNamed) {
  VerdictFeatures f = good();
  f.observed_share[segment_of("left_upper_leg")] = 0.2;
  f.observed_share[segment_of("left_leg")] = 0.1;
  Verdict verdict = judge(f);
  EXPECT_EQ(verdict.status, VerdictStatus::doubtful);
  EXPECT_TRUE(mentions(verdict, "left upper leg and left leg"));
  f = good();
  f.observed_share[segment_of("right_hand_index")] = 0.3;
  verdict = judge(f);
  EXPECT_EQ(verdict.status, VerdictStatus::ok) << "fingers are often missing";
  EXPECT_TRUE(mentions(verdict, "right hand index"));
  f.observed_share.fill(0.1);
  EXPECT_EQ(judge(f).status, VerdictStatus::failed);
}

TEST(Verdict, JointsAreNamed) {
  VerdictFeatures f = good();
  f.joint_limit_excess_rad = {{"left_elbow", 0.1}, {"right_knee", 0.6}};
  f.keypoint_disagreement_m = {{"left_wrist", 0.31}};
  const Verdict verdict = judge(f);
  EXPECT_EQ(verdict.status, VerdictStatus::doubtful);
  EXPECT_TRUE(mentions(verdict, "right knee"));
  EXPECT_FALSE(mentions(verdict, "left elbow"));
  EXPECT_TRUE(mentions(verdict, "left wrist (310 mm)"));
}

TEST(Verdict, ADetectorDoesNotOutweighASnugFit) {
  VerdictFeatures f = good();
  f.keypoint_disagreement_m = {{"left_wrist", 0.31}};
  EXPECT_EQ(judge(f).status, VerdictStatus::doubtful);
  f.model_to_scan_p95_mm = 3;
  EXPECT_EQ(judge(f).status, VerdictStatus::doubtful) << "one direction alone tells little";
  f.scan_to_model_p95_mm = 3;
  EXPECT_EQ(judge(f).status, VerdictStatus::ok);
  EXPECT_GT(judge(f).confidence, 0.8);
  f.opposed_share = 0.06;
  EXPECT_EQ(judge(f).status, VerdictStatus::doubtful) << "limbs may be exchanged";
}

TEST(Verdict, BareBodiesAreHeldToMore) {
  VerdictFeatures clothed = good();
  clothed.typical_mm = 24;
  clothed.scan_to_model_p95_mm = 32;
  clothed.opposed_share = 0.06;
  EXPECT_EQ(judge(clothed).status, VerdictStatus::ok);
  VerdictFeatures bare = clothed;
  bare.typical_mm = 16;
  const Verdict verdict = judge(bare);
  EXPECT_EQ(verdict.status, VerdictStatus::doubtful);
  EXPECT_TRUE(mentions(verdict, "not explained"));
  EXPECT_TRUE(mentions(verdict, "exchanged"));
  EXPECT_LT(verdict.confidence, judge(clothed).confidence);
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
  features.unseen_share[18] = 0.2;
  EXPECT_EQ(judge(features).status, VerdictStatus::doubtful);
}

TEST(Verdict, AMisfitHandMakesItDoubtfulAndIsNamed) {
  VerdictFeatures features;
  features.misfit_parts = {"left hand"};
  const Verdict verdict = judge(features);
  EXPECT_EQ(verdict.status, VerdictStatus::doubtful);
  EXPECT_NE(verdict.reasons.at(0).find("left hand"), std::string::npos);
  EXPECT_LT(verdict.confidence, 0.6);
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
