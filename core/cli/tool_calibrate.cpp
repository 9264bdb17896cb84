// vitruvian-calibrate MODELS_DIR OUT.json [BODIES]: learns where the landmarks sit on the default body.
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "cli/opencv_networks.h"
#include "io/file.h"
#include "pipeline/calibrate.h"

int main(int argc, char** argv) {
  using namespace vitruvian;
  if (argc < 3) {
    std::fprintf(stderr, "usage: vitruvian-calibrate MODELS_DIR OUT.json [BODIES]\n");
    return 2;
  }
  try {
    const std::string folder = std::string(argv[1]) + "/";
    const BodyModel body = read_body_model(FileBytes(folder + "body.vbm").bytes(), "body.vbm");
    const PosePrior prior = read_pose_prior(FileBytes(folder + "pose_prior.vpp").bytes(), "pose_prior.vpp");
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    OpenCvNetworks networks(folder + "blazepose_landmarks.opencv.onnx",
                            folder + "blazepose_detector.opencv.onnx", threads);
    Execution execution(threads);
    const Calibration calibration = calibrate_model(
        body, prior, argc > 3 ? std::atoi(argv[3]) : 32, 1,
        [&](const NetworkRequest& request) { return networks.run(request); }, execution);
    for (const CalibrationResidual& r : calibration.residuals) {
      std::printf("landmark %2d: median %.1f cm (uncalibrated %.1f)\n", r.landmark, 100 * r.median,
                  100 * r.uncalibrated);
    }
    write_file(argv[2], landmarks_to_json(calibration.offsets));
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
}
