#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/execution.h"
#include "pipeline/calibrate.h"
#include "pipeline/models.h"

namespace vitruvian {

/// A file in memory.
struct NamedBytes {
  std::span<const std::byte> bytes;
  std::string name;  ///< its path, for messages and a model's gender
};

/// What a user's model file is for.
enum class ModelFileKind { body, soft_tissue, prior };

/// Told by the file's content: a NumPy archive with `v_template`, a pickle, or the default body's array file
/// is a body model; a NumPy archive with `eigvec` is soft tissue (DMPL); a PyTorch archive is a pose prior
/// (VPoser).
/// @throws Error(unsupported_format) for anything else, Error(bad_file) for a damaged archive.
ModelFileKind kind_of_model_file(const NamedBytes& file);

/// A user's prior: one of ours, or a VPoser checkpoint, which takes the place of our autoencoder.
/// @throws Error(bad_model, bad_file, unsupported_format).
PosePrior prior_with_file(PosePrior bundled, const NamedBytes& file);

/// Files that a user brought; those that are missing are as they come with the program.
struct OwnModelFiles {
  std::optional<NamedBytes> body, soft_tissue, prior;
  int betas = 0;  ///< 0: the default number
};

/// Puts together what a registration needs when a user brought some of it, in steps, because landmarks are
/// learnt by looking at the model through the networks:
///
///   OwnModels own(bundled, files, execution);
///   while (auto request = own.next_request()) own.accept(run(*request));
///   const Models models = own.take();
class OwnModels {
 public:
  /// Reads the files; they are not needed afterwards.
  /// @param bundled, execution  must outlive the object.
  /// @throws Error(usage, bad_model, bad_file, unsupported_format).
  OwnModels(const Models& bundled, const OwnModelFiles& files, const Execution& execution);

  const BodyModel& body() const { return models_->body; }
  /// Landmarks learnt earlier of body(), in SMPL's numbering: the networks are then not needed.
  void set_learnt(std::vector<LandmarkOffset> landmarks);
  /// The landmarks of the user's body model, to be kept by its sha256; none for the bundled body or before
  /// they are learnt.
  const std::optional<std::vector<LandmarkOffset>>& learnt() const { return learnt_; }

  /// @throws Error(cancelled).
  std::optional<NetworkRequest> next_request();
  void accept(const NetworkReply& reply);
  /// After next_request() returned nothing; once.
  Models take();

 private:
  const Execution& execution_;
  std::unique_ptr<Models> models_;  // at one address: the calibrator refers to it
  PosePrior calibration_prior_;
  bool own_body_ = false;
  std::optional<LandmarkCalibrator> calibrator_;
  std::optional<std::vector<LandmarkOffset>> learnt_;
};

}  // namespace vitruvian
