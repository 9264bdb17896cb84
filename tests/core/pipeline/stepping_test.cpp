#include <gtest/gtest.h>

#include <string>

#include "core/pipeline/all_knowing_network.h"
#include "pipeline/pipeline.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using namespace testing;

constexpr PipelineStage kStages[] = {PipelineStage::align, PipelineStage::keypoints, PipelineStage::pose,
                                     PipelineStage::fit};

class Stepping : public ::testing::Test {
 protected:
  Stepping() { pipeline_.set_scan(scan_of(truth_)); }

  /// Works up to a stage. @return the number of network requests.
  int step(PipelineStage until) {
    int requests = 0;
    while (const auto request = pipeline_.next_request(until)) {
      ++requests;
      pipeline_.accept(network_.run(pipeline_, *request));
    }
    return requests;
  }

  std::string finished() { return bytes(pipeline_.finish()); }

  std::string at_once(const Settings& settings) const {
    const Execution execution(2);
    RegistrationPipeline pipeline(models(), settings, execution);
    pipeline.set_scan(scan_of(truth_));
    while (const auto request = pipeline.next_request()) pipeline.accept(network_.run(pipeline, *request));
    return bytes(pipeline.finish());
  }

  /// at_once(pca_settings()), worked once for all tests.
  const std::string& reference() const {
    static const std::string result = at_once(pca_settings());
    return result;
  }

  static std::string bytes(Registration r) {
    r.timing_ms = Timing();
    return registration_json(r, "1", JsonStyle::pretty);
  }

  BodyState truth_ = standing();
  AllKnowingNetwork network_{truth_};
  Execution execution_{2};
  RegistrationPipeline pipeline_{models(), pca_settings(), execution_};
};

TEST_F(Stepping, ShowsWhatEachStageFoundAndEndsAsAtOnce) {
  EXPECT_THROW(pipeline_.align_finding(), Error);
  EXPECT_EQ(pipeline_.landmark_stage(), nullptr);
  EXPECT_EQ(step(PipelineStage::align), 0);
  EXPECT_TRUE(pipeline_.reached(PipelineStage::align));
  EXPECT_FALSE(pipeline_.reached(PipelineStage::keypoints));
  const auto aligned = pipeline_.align_finding();
  EXPECT_EQ(aligned.alignment.up, "z");
  EXPECT_EQ(aligned.alignment.unit, Unit::millimetre);
  EXPECT_NEAR(aligned.height_m, 1.73, 0.15);
  EXPECT_THROW(pipeline_.keypoints(), Error);

  EXPECT_EQ(step(PipelineStage::keypoints), 1);
  const Skeleton skeleton = pose_skeleton(default_body(), truth_);
  const Points3d joints_scan = to_scan(skeleton.joints);
  const std::vector<Keypoint> keypoints = pipeline_.keypoints();
  const Mat4d body_from_scan = pipeline_.align_finding().alignment.body_from_scan;
  const Vec3d knee = (body_from_scan * joints_scan.col(4).homogeneous()).head<3>();
  EXPECT_LT((*keypoints[4].position_m - knee).norm(), 0.05);
  EXPECT_THROW(pipeline_.initial_pose(), Error);

  EXPECT_EQ(step(PipelineStage::pose), 0);
  const Skeleton posed = pose_skeleton(default_body(), pipeline_.initial_pose());
  EXPECT_LT((posed.joints.col(4) - knee).norm(), 0.05);
  EXPECT_THROW(pipeline_.finish(), Error);

  EXPECT_EQ(step(PipelineStage::fit), 0);
  const std::string stepped = finished();
  EXPECT_EQ(stepped, reference());
  EXPECT_EQ(stepped, finished());
}

TEST_F(Stepping, GoesOnFromTheStageThatAChangeTouches) {
  step(PipelineStage::fit);
  Settings settings = pca_settings();
  settings.gender = Gender::female;
  pipeline_.configure(settings);
  EXPECT_TRUE(pipeline_.reached(PipelineStage::keypoints));
  EXPECT_FALSE(pipeline_.reached(PipelineStage::pose));
  EXPECT_EQ(step(PipelineStage::fit), 0);
  EXPECT_EQ(finished(), at_once(settings));

  settings.views = 2;
  pipeline_.configure(settings);
  EXPECT_TRUE(pipeline_.reached(PipelineStage::align));
  EXPECT_FALSE(pipeline_.reached(PipelineStage::keypoints));
  EXPECT_EQ(step(PipelineStage::keypoints), 1);
  EXPECT_EQ(pipeline_.landmark_stage()->views().size(), 2u);

  settings.unit = Unit::inch;
  pipeline_.configure(settings);
  EXPECT_FALSE(pipeline_.reached(PipelineStage::align));
  step(PipelineStage::align);
  EXPECT_EQ(pipeline_.align_finding().alignment.unit, Unit::inch);
  EXPECT_GT(pipeline_.align_finding().height_m, 30);

  pipeline_.configure(pca_settings());
  EXPECT_EQ(step(PipelineStage::fit), 1);
  EXPECT_EQ(finished(), reference());
}

TEST_F(Stepping, WorksAStageAnewWhenToldTo) {
  step(PipelineStage::fit);
  for (const PipelineStage stage : kStages) {
    pipeline_.forget(stage);
    EXPECT_FALSE(pipeline_.reached(stage));
    EXPECT_FALSE(pipeline_.reached(PipelineStage::fit));
    EXPECT_EQ(step(PipelineStage::fit), stage <= PipelineStage::keypoints ? 1 : 0);
    EXPECT_EQ(finished(), reference());
  }
}

TEST_F(Stepping, GoesOnAfterACancel) {
  for (const std::string stage : {"project", "pose", "fit"}) {
    SCOPED_TRACE(stage);
    pipeline_.forget(PipelineStage::align);
    execution_.on_progress([&](std::string_view now, double) {
      if (now == stage) execution_.cancel();
    });
    EXPECT_THROW(step(PipelineStage::fit), Error);
    execution_.on_progress({});
    execution_.reset_cancel();
    for (const PipelineStage each : kStages) {
      if (!pipeline_.reached(each)) {
        pipeline_.forget(each);
        break;
      }
    }
    step(PipelineStage::fit);
    EXPECT_EQ(finished(), reference());
  }
}

TEST_F(Stepping, RefusesSettingsThatAreNotOfferedAndKeepsTheOldOnes) {
  step(PipelineStage::pose);
  Settings settings = pca_settings();
  settings.views = 5;
  EXPECT_THROW(pipeline_.configure(settings), Error);
  EXPECT_TRUE(pipeline_.reached(PipelineStage::pose));
}

TEST(FirstAffected, IsTheEarliestStageThatKnowsTheSetting) {
  const Settings before;
  EXPECT_EQ(first_affected(before, before), std::nullopt);
  const auto affected = [&](auto change) {
    Settings after = before;
    change(after);
    return first_affected(before, after);
  };
  EXPECT_EQ(affected([](Settings& s) { s.unit = Unit::inch; }), PipelineStage::align);
  EXPECT_EQ(affected([](Settings& s) { s.up = Axis::x; }), PipelineStage::align);
  EXPECT_EQ(affected([](Settings& s) { s.views = 2; }), PipelineStage::keypoints);
  EXPECT_EQ(affected([](Settings& s) { s.gender = Gender::male; }), PipelineStage::pose);
  EXPECT_EQ(affected([](Settings& s) { s.detail = DetailMode::vertex; }), PipelineStage::fit);
  const auto several = [](Settings& s) { s.gender = Gender::male, s.front = Axis::y; };
  EXPECT_EQ(affected(several), PipelineStage::align);
}

TEST(StageClock, ReplacesTheTimeOfAStageThatIsRunAgain) {
  StageClock clock;
  const auto spend = [&](PipelineStage stage, double Timing::*entry) {
    clock.work_for(stage);
    clock.enter(entry);
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(2)) {
    }
    clock.pause();
  };
  spend(PipelineStage::keypoints, &Timing::detect);
  spend(PipelineStage::fit, &Timing::fit);
  const Timing first = clock.sum();
  EXPECT_GE(first.detect, 2);
  EXPECT_GE(first.fit, 2);
  EXPECT_DOUBLE_EQ(first.total, first.detect + first.fit);
  clock.forget(PipelineStage::fit);
  EXPECT_EQ(clock.sum().detect, first.detect);
  EXPECT_EQ(clock.sum().fit, 0);
}

}  // namespace
}  // namespace vitruvian
