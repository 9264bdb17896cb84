#include "pipeline/own_models.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/error.h"
#include "base/sha256.h"
#include "io/npz.h"
#include "pose/skeleton_prior.h"
#include "smpl/read_model.h"
#include "smpl/vposer.h"

namespace vitruvian {
namespace {

constexpr int kCalibrationBodies = 20;
constexpr std::uint32_t kCalibrationSeed = 1;

bool begins_with(const NamedBytes& file, std::string_view magic) {
  return file.bytes.size() >= magic.size() && std::memcmp(file.bytes.data(), magic.data(), magic.size()) == 0;
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

FileInfo file_info(const NamedBytes& file) { return {file.name, to_hex(sha256(file.bytes))}; }

}  // namespace

ModelFileKind kind_of_model_file(const NamedBytes& file) {
  if (is_array_file(file.bytes))
    return ends_with(file.name, ".vpp") ? ModelFileKind::prior : ModelFileKind::body;
  // Pickles of protocol 2 and later say so; older ones, which are text, begin with a dictionary or an object.
  if (begins_with(file, "\x80") || begins_with(file, "(dp") || begins_with(file, "ccopy_reg"))
    return ModelFileKind::body;
  if (begins_with(file, "PK")) {
    const NpzFile zip(file.bytes, file.name);
    if (zip.has("v_template")) return ModelFileKind::body;
    if (zip.has("eigvec")) return ModelFileKind::soft_tissue;
    const std::vector<std::string> names = zip.names();
    if (std::any_of(names.begin(), names.end(), [](const auto& name) { return ends_with(name, "data.pkl"); }))
      return ModelFileKind::prior;
  }
  throw Error(ErrorCode::unsupported_format,
              file.name +
                  ": is no body model (SMPL, SMPL+H, SMPL-X or STAR as .pkl or .npz), no soft tissue "
                  "(DMPL .npz) and no pose prior (VPoser .ckpt)");
}

PosePrior prior_with_file(PosePrior bundled, const NamedBytes& file) {
  if (is_array_file(file.bytes)) return read_pose_prior(file.bytes, file.name);
  bundled.vae = read_vposer(file.bytes, file.name);
  bundled.sha256 = to_hex(sha256(file.bytes));
  return bundled;
}

OwnModels::OwnModels(const Models& bundled, const OwnModelFiles& files, const Execution& execution)
    : execution_(execution), models_(std::make_unique<Models>(bundled)), own_body_(files.body.has_value()) {
  if (own_body_) {
    SmplOptions options;
    options.betas = files.betas;
    models_->body = read_any_body_model(files.body->bytes, files.body->name, options);
    own_body_ = models_->body.family != bundled.body.family;
  }
  if (files.soft_tissue) {
    add_dmpl(models_->body, files.soft_tissue->bytes, files.soft_tissue->name);
    models_->dmpl = file_info(*files.soft_tissue);
  }
  if (files.prior) models_->users_prior = file_info(*files.prior);
  const PosePrior chosen = files.prior ? prior_with_file(bundled.prior, *files.prior) : bundled.prior;
  models_->prior = prior_for_skeleton(chosen, models_->body);
  // Learnt with the bundled prior, so that the result depends on the model alone.
  if (own_body_) calibration_prior_ = prior_for_skeleton(bundled.prior, models_->body);
}

void OwnModels::set_learnt(std::vector<LandmarkOffset> landmarks) { learnt_ = std::move(landmarks); }

std::optional<NetworkRequest> OwnModels::next_request() {
  if (!own_body_ || learnt_) return std::nullopt;
  if (!calibrator_)
    calibrator_.emplace(models_->body, calibration_prior_, kCalibrationBodies, kCalibrationSeed, execution_);
  if (auto request = calibrator_->next_request()) return request;
  learnt_ = calibrator_->result().offsets;
  calibrator_.reset();
  return std::nullopt;
}

void OwnModels::accept(const NetworkReply& reply) {
  if (!calibrator_) throw Error(ErrorCode::internal, "a reply to a request that was not made");
  calibrator_->accept(reply);
}

Models OwnModels::take() {
  if (own_body_ && !learnt_) throw Error(ErrorCode::internal, "the landmarks have not been learnt yet");
  if (own_body_) models_->landmarks = landmarks_on(models_->body, *learnt_);
  return std::move(*models_);
}

}  // namespace vitruvian
