#include "cli/wiring.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include "cli/model_loading.h"
#include "cli/opencv_networks.h"
#include "cli/paths.h"
#include "pipeline/check_settings.h"
#include "pipeline/pipeline.h"
#include "smpl/smpl_model.h"

namespace vitruvian {

BodyOpener native_body(std::vector<std::string> folders) {
  return [folders = std::move(folders)](const std::string& model_file, const std::string& dmpl_file) {
    ModelFiles files;
    files.model = model_file;
    files.dmpl = dmpl_file;
    files.betas = kEveryBeta;
    return load_body_model(files, folders);
  };
}

RegisterFactory native_register(std::vector<std::string> folders, const std::string& cache) {
  return [folders = std::move(folders),
          cache = CalibrationCache(cache)](const RegisterArguments& arguments) -> RegisterFunction {
    const std::string landmarks = find_data_file(folders, "blazepose_landmarks.opencv.onnx");
    const std::string detector = find_data_file(folders, "blazepose_detector.opencv.onnx");
    const int threads = arguments.settings.threads > 0
                            ? arguments.settings.threads
                            : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    // Opened only for a model that was never looked at.
    std::optional<OpenCvNetworks> eyes;
    const Execution setup(threads);
    const auto models = std::make_shared<const Models>(load_models(
        {arguments.model_file, arguments.dmpl_file, arguments.prior_file, arguments.settings.betas}, folders,
        cache,
        [&](const NetworkRequest& request) {
          if (!eyes) {
            if (!arguments.quiet) std::cerr << "learning where landmarks lie on this model (once)\n";
            eyes.emplace(landmarks, detector, threads);
          }
          return eyes->run(request);
        },
        setup));
    if (arguments.project) check_model(*arguments.project, models->body);
    check_settings(arguments.settings, *models);
    return [=](Scan scan, const Settings& settings, const Execution& execution, double read_ms) {
      OpenCvNetworks networks(landmarks, detector, settings.threads);
      return register_scan(
          std::move(scan), *models, settings,
          [&](const NetworkRequest& request) { return networks.run(request); }, execution, read_ms);
    };
  };
}

}  // namespace vitruvian
