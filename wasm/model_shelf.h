#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "buffer.h"
#include "pipeline/models.h"
#include "pipeline/own_models.h"

namespace vitruvian::wasm {

/// Values are known to web/src/worker/core.ts.
enum class ModelPart { body = 0, prior = 1, landmarks = 2 };

/// The models that come with the page, and those that a user put in their place.
class ModelShelf {
 public:
  /// Reads a file that comes with the page. @throws Error(bad_model).
  void load(ModelPart part, const Buffer& file, const std::string& name);

  /// What a registration uses.
  const Models& models() const { return own_ ? *own_ : bundled_; }

  /// Takes a user's file for begin(). @throws Error(usage) for the second of a kind, and as
  /// kind_of_model_file(); those that were added before are then let go.
  ModelFileKind add(Buffer file, std::string name);
  /// Reads the files that were added, and lets them go; with none, the bundled models are in use again.
  /// @param known  JSON object of what earlier reports had in `landmarks`, texts by sha256: used for the same
  ///               body.
  /// @throws as OwnModels; the models in use stay as they were.
  void begin(const std::string& known, const Execution& execution);
  /// The next pictures to look at, or none: the models are then in use.
  std::optional<NetworkRequest> next_request();
  void accept(const NetworkReply& reply);
  /// Gives up what is under way.
  void abandon() { assembly_.reset(); }

  /// `{"name", "family", "vertices", "betas", "joints", "sha256", "own", "landmarks"}` of the models in use;
  /// `landmarks` is text to be kept for begin(), or null.
  std::string report() const;

 private:
  struct Added {
    Buffer buffer;
    std::string name;
  };

  Models bundled_;
  std::unique_ptr<Models> own_;
  std::string learnt_;
  std::array<std::optional<Added>, 3> added_;  // by ModelFileKind
  std::unique_ptr<OwnModels> assembly_;
};

}  // namespace vitruvian::wasm
