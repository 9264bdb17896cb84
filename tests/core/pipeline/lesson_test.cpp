#include "pipeline/lesson.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/pipeline/all_knowing_network.h"

namespace vitruvian {
namespace {

using namespace testing;

class Lessons : public ::testing::Test {
 protected:
  Lessons() {
    pipeline_.set_scan(scan_of(truth_));
    while (const auto request = pipeline_.next_request(PipelineStage::keypoints))
      pipeline_.accept(network_.run(pipeline_, *request));
  }

  /// Median of the fitted body's distances, m.
  static float median(Lesson lesson) {
    const auto middle = lesson.residual_m.begin() + static_cast<std::ptrdiff_t>(lesson.residual_m.size() / 2);
    std::nth_element(lesson.residual_m.begin(), middle, lesson.residual_m.end());
    return *middle;
  }

  BodyState truth_ = standing();
  AllKnowingNetwork network_{truth_};
  Execution execution_{2};
  RegistrationPipeline pipeline_{models(), pca_settings(), execution_};
};

TEST_F(Lessons, FitAsTheRegistrationDoesAndCanBeRepeated) {
  const Lesson lesson = run_lesson(pipeline_, {}, execution_);
  ASSERT_EQ(lesson.steps.size(), 30u + 36u + 1u);
  EXPECT_EQ(lesson.residual_m.size(), static_cast<std::size_t>(models().body.vertex_count()));
  EXPECT_LT(median(lesson), 0.003f);
  const Lesson again = run_lesson(pipeline_, {}, execution_);
  EXPECT_EQ(lesson.steps.back().joints, again.steps.back().joints);
  EXPECT_EQ(joints_apart(lesson, again).largest_m, 0);
  EXPECT_THROW(joints_apart(lesson, Lesson()), Error);
}

TEST_F(Lessons, ShowWhatTheKeypointsAreGoodFor) {
  LessonSettings settings;
  settings.iterations = 4;
  const float aligned = median(run_lesson(pipeline_, settings, execution_));
  settings.tpose = true;
  const Lesson rest = run_lesson(pipeline_, settings, execution_);
  EXPECT_TRUE(rest.targets.empty());
  EXPECT_EQ(rest.steps.front().stage, 0);
  EXPECT_EQ(rest.steps.size(), 5u);
  EXPECT_LT(aligned, median(rest));
  const JointsApart apart = joints_apart(rest, run_lesson(pipeline_, {}, execution_));
  EXPECT_GT(apart.largest_m, 0.05);
  EXPECT_LT(apart.mean_m, apart.largest_m);
  settings.tpose = false;
  settings.keypoint_noise_m = 0.2;
  EXPECT_LT(aligned, median(run_lesson(pipeline_, settings, execution_)));
}

TEST_F(Lessons, RefuseWhatMakesNoSense) {
  for (const LessonSettings& bad :
       {LessonSettings{.keypoint_noise_m = -1}, LessonSettings{.prior_weight = 1e9},
        LessonSettings{.prior_weight = std::nan("")}, LessonSettings{.iterations = 0}}) {
    EXPECT_THROW(run_lesson(pipeline_, bad, execution_), Error);
  }
  pipeline_.forget(PipelineStage::keypoints);
  EXPECT_THROW(run_lesson(pipeline_, {}, execution_), Error);
}

}  // namespace
}  // namespace vitruvian
