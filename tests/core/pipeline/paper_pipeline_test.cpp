#include "pipeline/paper_pipeline.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "core/pipeline/all_knowing_network.h"
#include "measure/correspondence.h"
#include "pipeline/pipeline.h"

namespace vitruvian {
namespace {

using testing::default_body;
using testing::default_fit_model;
using testing::models;
using testing::scan_from_body;
using testing::scan_of;
using testing::standing;

std::vector<Keypoint> true_keypoints(const BodyState& state) {
  const Points3d joints = pose_skeleton(default_body(), state).joints;
  std::vector<Keypoint> keypoints;
  for (int j = 0; j < 22; ++j)
    keypoints.push_back({std::string(kSmplJointNames[j]), joints.col(j), 1, KeypointSource::user});
  return keypoints;
}

TEST(PaperPose, BringsTheJointsToTheirKeypointsFromTheCanonicalStart) {
  BodyState truth = testing::test_state(2, 3);
  truth.rotation[0] = Mat3d::Identity();
  truth.translation.setZero();
  const std::vector<Keypoint> keypoints = true_keypoints(truth);
  for (const std::optional<Vec3d>& start :
       {std::optional<Vec3d>(Vec3d(0.02, -0.1, 0.03)), std::optional<Vec3d>()}) {
    const BodyState found = paper_pose(default_fit_model(), keypoints, start, Execution(1));
    const Points3d joints = pose_skeleton(default_body(), found).joints;
    double sum = 0;
    for (int j = 0; j < 22; ++j) sum += (joints.col(j) - *keypoints[j].position_m).norm() / 22;
    EXPECT_LT(sum, 0.03) << (start ? "canonical start" : "trunk first");
  }
}

TEST(RematchRegions, NeverCrossesAPairAndEqualsThePlainMatchWithoutRegions) {
  const Points3f vertices = Points3f::Random(3, 200), scan = Points3f::Random(3, 300);
  const Execution execution(2);
  EXPECT_EQ(rematch_regions(vertices, scan, {}, execution), rematch(vertices, scan, KdTree(scan), execution));
  RegionLabels regions{3, {}, {}};
  for (int i = 0; i < 300; ++i) regions.scan.push_back(i % 3);
  for (int v = 0; v < 200; ++v) regions.vertices.push_back(v % 3);
  const std::vector<int> matches = rematch_regions(vertices, scan, regions, execution);
  for (int v = 0; v < 200; ++v) {
    ASSERT_GE(matches[v], 0);
    EXPECT_EQ(matches[v] % 3, v % 3);
    for (int i = v % 3; i < 300; i += 3) {
      EXPECT_LE((scan.col(matches[v]) - vertices.col(v)).norm(), (scan.col(i) - vertices.col(v)).norm());
    }
  }
}

/// The published solver in the pipeline, from an earlier body; no network needed.
Settings paper_settings(const BodyState& start) {
  Settings settings;
  settings.solver = SolverKind::paper;
  settings.iterations = 40;
  settings.adam_iterations = 20;
  settings.body_from_scan = scan_from_body().inverse();
  settings.init = InitMode::file;
  settings.start = StartBody{{start.betas, start.axis_angle(), start.translation, ""}, default_body().sha256};
  return settings;
}

TEST(PaperPipeline, FitsInTheScansFrameAndIsNotRefinedFurther) {
  const BodyState truth = standing();
  const BodyState start = testing::perturbed(truth, 0.05, 0.2, 4);
  const Execution execution(2);
  RegistrationPipeline pipeline(models(), paper_settings(start), execution);
  pipeline.set_scan(scan_of(truth));
  ASSERT_FALSE(pipeline.next_request());
  const Registration r = pipeline.finish();
  ASSERT_TRUE(r.parameters && r.surface_error);
  const auto error = [&](const BodyState& state) {
    return (posed_vertices<double>(default_body(), state) - posed_vertices<double>(default_body(), truth))
        .colwise()
        .norm()
        .mean();
  };
  const BodyState found =
      BodyState::from_axis_angle(r.parameters->pose, r.parameters->betas, r.parameters->translation_m);
  EXPECT_LT(error(found), 0.5 * error(start));
  EXPECT_GT(r.timing_ms.fit, 0);
  EXPECT_GT(r.timing_ms.refine, 0);
}

TEST(PaperPipeline, StopsWhenCancelledInEitherStage) {
  const BodyState truth = standing();
  for (const std::string stage : {"fit", "refine"}) {
    SCOPED_TRACE(stage);
    Execution execution(2);
    execution.on_progress([&](std::string_view now, double fraction) {
      if (now == stage && fraction > 0) execution.cancel();
    });
    RegistrationPipeline pipeline(models(), paper_settings(truth), execution);
    pipeline.set_scan(scan_of(truth));
    EXPECT_THROW(pipeline.next_request(), Error);
  }
}

}  // namespace
}  // namespace vitruvian
