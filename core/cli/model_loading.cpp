#include "cli/model_loading.h"

#include <filesystem>

#include "base/sha256.h"
#include "cli/paths.h"
#include "io/file.h"
#include "pipeline/calibrate.h"
#include "pipeline/own_models.h"
#include "pose/skeleton_prior.h"
#include "smpl/read_model.h"

namespace vitruvian {
namespace {

constexpr int kCalibrationBodies = 20;
constexpr std::uint32_t kCalibrationSeed = 1;

PosePrior prior_from(const PosePrior& bundled, const std::string& path) {
  const FileBytes file(path);
  return prior_with_file(bundled, {file.bytes(), path});
}

PosePrior read_prior(const std::string& path) { return read_pose_prior(FileBytes(path).bytes(), path); }

}  // namespace

FileInfo file_info(const std::string& path) {
  return {std::filesystem::path(path).filename().string(), to_hex(sha256(FileBytes(path).bytes()))};
}

BodyModel load_body_model(const ModelFiles& files, const std::vector<std::string>& data_folders) {
  const std::string path = files.model.empty() ? find_data_file(data_folders, "body.vbm") : files.model;
  const FileBytes file(path);
  SmplOptions options;
  options.betas = files.betas;
  BodyModel body = read_any_body_model(file.bytes(), path, options);
  if (!files.dmpl.empty()) {
    const FileBytes dmpl(files.dmpl);
    add_dmpl(body, dmpl.bytes(), files.dmpl);
  }
  return body;
}

Models load_models(const ModelFiles& files, const std::vector<std::string>& data_folders,
                   const CalibrationCache& cache,
                   const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                   const Execution& execution) {
  Models models;
  models.body = load_body_model(files, data_folders);
  if (!files.dmpl.empty()) models.dmpl = file_info(files.dmpl);
  if (!files.prior.empty()) models.users_prior = file_info(files.prior);
  const PosePrior bundled = read_prior(find_data_file(data_folders, "pose_prior.vpp"));
  const PosePrior chosen = files.prior.empty() ? bundled : prior_from(bundled, files.prior);
  models.prior = prior_for_skeleton(chosen, models.body);
  if (models.body.family == "vitruvian") {
    const std::string path = find_data_file(data_folders, "landmarks.json");
    const FileBytes text(path);
    models.landmarks = landmarks_from_json(
        std::string(reinterpret_cast<const char*>(text.bytes().data()), text.bytes().size()), path);
    return models;
  }
  auto known = cache.find(models.body.sha256);
  if (!known) {
    // Learnt with the bundled prior, so that the result depends on the model alone.
    known = calibrate_model(models.body, prior_for_skeleton(bundled, models.body), kCalibrationBodies,
                            kCalibrationSeed, run_network, execution)
                .offsets;
    cache.keep(models.body.sha256, *known);
  }
  models.landmarks = landmarks_on(models.body, *known);
  return models;
}

}  // namespace vitruvian
