#include "cli/wiring.h"

#include <memory>

#include "cli/opencv_networks.h"
#include "cli/paths.h"
#include "io/file.h"
#include "keypoints/landmark_calibration.h"
#include "pipeline/check_settings.h"
#include "pipeline/pipeline.h"

namespace vitruvian {
namespace {

BodyModel load_body(const std::string& model_file, const std::vector<std::string>& folders) {
  const std::string path = model_file.empty() ? find_data_file(folders, "body.vbm") : model_file;
  return read_body_model(FileBytes(path).bytes(), path);
}

Models load_models(const RegisterArguments& arguments, const std::vector<std::string>& folders) {
  Models models;
  models.body = load_body(arguments.model_file, folders);
  const std::string prior = find_data_file(folders, "pose_prior.vpp");
  models.prior = read_pose_prior(FileBytes(prior).bytes(), prior);
  const std::string landmarks = find_data_file(folders, "landmarks.json");
  const FileBytes text(landmarks);
  models.landmarks = landmarks_from_json(
      std::string(reinterpret_cast<const char*>(text.bytes().data()), text.bytes().size()), landmarks);
  return models;
}

}  // namespace

BodyOpener native_body(std::vector<std::string> folders) {
  return [folders = std::move(folders)](const std::string& model_file) {
    return load_body(model_file, folders);
  };
}

RegisterFactory native_register(std::vector<std::string> folders) {
  return [folders = std::move(folders)](const RegisterArguments& arguments) -> RegisterFunction {
    const auto models = std::make_shared<const Models>(load_models(arguments, folders));
    check_settings(arguments.settings, *models);
    const std::string landmarks = find_data_file(folders, "blazepose_landmarks.opencv.onnx");
    const std::string detector = find_data_file(folders, "blazepose_detector.opencv.onnx");
    return [=](Scan scan, const Settings& settings, const Execution& execution, double read_ms) {
      OpenCvNetworks networks(landmarks, detector, settings.threads);
      return register_scan(
          std::move(scan), *models, settings,
          [&](const NetworkRequest& request) { return networks.run(request); }, execution, read_ms);
    };
  };
}

}  // namespace vitruvian
