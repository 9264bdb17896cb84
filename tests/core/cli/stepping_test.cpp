#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "cli/opencv_networks.h"
#include "core/pipeline/all_knowing_network.h"
#include "io/file.h"
#include "pipeline/pipeline.h"
#include "pipeline/result_json.h"
#include "pipeline/settings_names.h"

namespace vitruvian {
namespace {

std::string data_folder() {
  const char* data = std::getenv("VITRUVIAN_DATA");
  return data ? data : VITRUVIAN_MODELS_DIR;
}

/// The sample scan with the real networks, everything found by itself.
class SteppingWithNetworks : public ::testing::Test {
 protected:
  SteppingWithNetworks() {
    const std::string file = data_folder() + "/sample.ply";
    scan_ = std::make_shared<const Scan>(read_scan(FileBytes(file).bytes(), "sample.ply", execution_));
  }

  int step(RegistrationPipeline& pipeline, PipelineStage until) {
    int requests = 0;
    while (const auto request = pipeline.next_request(until)) {
      ++requests;
      pipeline.accept(networks_.run(*request));
    }
    return requests;
  }

  std::string at_once(const Settings& settings) {
    RegistrationPipeline pipeline(testing::models(), settings, execution_);
    pipeline.set_scan(scan_);
    step(pipeline, PipelineStage::fit);
    return bytes(pipeline);
  }

  static std::string bytes(RegistrationPipeline& pipeline) {
    Registration r = pipeline.finish();
    r.timing_ms = Timing();
    return registration_json(r, "1", JsonStyle::pretty);
  }

  Execution execution_{2};
  OpenCvNetworks networks_{data_folder() + "/blazepose_landmarks.opencv.onnx",
                           data_folder() + "/blazepose_detector.opencv.onnx", 2};
  std::shared_ptr<const Scan> scan_;
};

TEST_F(SteppingWithNetworks, EndsAsAtOnceAlsoAfterDetours) {
  RegistrationPipeline pipeline(testing::models(), Settings(), execution_);
  pipeline.set_scan(scan_);
  EXPECT_GT(step(pipeline, PipelineStage::align), 1);
  const auto aligned = pipeline.align_finding();
  EXPECT_EQ(aligned.alignment.unit, Unit::millimetre);
  EXPECT_TRUE(aligned.front_is_known);
  EXPECT_GT(aligned.height_m, 1.4);
  EXPECT_LT(aligned.height_m, 2.1);
  // The look all round that told the front serves for the keypoints too.
  EXPECT_EQ(step(pipeline, PipelineStage::keypoints), 0);
  EXPECT_EQ(pipeline.align_finding().alignment.body_from_scan, aligned.alignment.body_from_scan);

  Settings other;
  other.views = 2;
  pipeline.configure(other);
  EXPECT_GT(step(pipeline, PipelineStage::pose), 0);
  other.front = *value_named<Axis>(aligned.alignment.front);
  pipeline.configure(other);
  EXPECT_FALSE(pipeline.reached(PipelineStage::align));
  // The user's front needs no look, and up is known.
  EXPECT_EQ(step(pipeline, PipelineStage::align), 0);

  pipeline.configure(Settings());
  step(pipeline, PipelineStage::pose);
  step(pipeline, PipelineStage::fit);
  EXPECT_EQ(bytes(pipeline), at_once(Settings()));
  pipeline.configure(other);
  step(pipeline, PipelineStage::fit);
  EXPECT_EQ(bytes(pipeline), at_once(other));
}

}  // namespace
}  // namespace vitruvian
