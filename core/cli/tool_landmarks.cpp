// vitruvian-landmarks SCAN MODELS...: the landmarks that the networks see in the pictures of a scan, as
// JSON:
// [[[u, v, visibility] x 33] a picture], in pixels of the picture. For comparing this program's networks with
// those of the page. MODELS: folders searched for models.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/opencv_networks.h"
#include "cli/paths.h"
#include "io/file.h"
#include "pipeline/pipeline.h"

namespace {
using namespace vitruvian;

nlohmann::json landmarks_of(const LandmarkStage& stage) {
  nlohmann::json pictures = nlohmann::json::array();
  for (const ViewLandmarks& view : stage.view_landmarks()) {
    nlohmann::json dots = nlohmann::json::array();
    for (const ViewLandmark& l : view.landmarks) dots.push_back({l.pixel.x(), l.pixel.y(), l.visibility});
    pictures.push_back(dots);
  }
  return pictures;
}

void run(int argc, char** argv) {
  if (argc < 3) throw Error(ErrorCode::usage, "usage: vitruvian-landmarks SCAN MODELS...");
  const std::vector<std::string> folders(argv + 2, argv + argc);
  const Execution execution(2);
  const auto read = [&](const char* name) { return FileBytes(find_data_file(folders, name)); };
  Models models;
  models.body = read_body_model(read("body.vbm").bytes(), "body.vbm");
  models.prior = read_pose_prior(read("pose_prior.vpp").bytes(), "pose_prior.vpp");
  OpenCvNetworks networks(find_data_file(folders, "blazepose_landmarks.opencv.onnx"),
                          find_data_file(folders, "blazepose_detector.opencv.onnx"), 2);
  RegistrationPipeline pipeline(models, Settings(), execution);
  pipeline.set_scan(read_scan(FileBytes(argv[1]).bytes(), argv[1], execution));
  while (const auto request = pipeline.next_request(PipelineStage::keypoints))
    pipeline.accept(networks.run(*request));
  std::printf("%s\n", landmarks_of(*pipeline.landmark_stage()).dump().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc, argv);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vitruvian-landmarks: %s\n", error.what());
    return 1;
  }
}
