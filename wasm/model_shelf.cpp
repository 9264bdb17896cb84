#include "model_shelf.h"

#include <utility>

#include "session_json.h"

namespace vitruvian::wasm {

void ModelShelf::load(ModelPart part, const Buffer& file, const std::string& name) {
  switch (part) {
    case ModelPart::body:
      bundled_.body = read_body_model(file.bytes(), name);
      return;
    case ModelPart::prior:
      bundled_.prior = read_pose_prior(file.bytes(), name);
      return;
    case ModelPart::landmarks:
      bundled_.landmarks = landmarks_from_json(
          std::string(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()), name);
      return;
  }
  throw Error(ErrorCode::internal, "unknown model part");
}

ModelFileKind ModelShelf::add(Buffer file, std::string name) {
  // What was added with a file that cannot be used is not used by itself.
  auto others = std::exchange(added_, {});
  const ModelFileKind kind = kind_of_model_file({file.bytes(), name});
  std::optional<Added>& place = others[static_cast<std::size_t>(kind)];
  if (place)
    throw Error(ErrorCode::usage, place->name + " and " + name + " are for the same: open one of them");
  place = Added{std::move(file), std::move(name)};
  added_ = std::move(others);
  return kind;
}

void ModelShelf::begin(const std::string& known, const Execution& execution) {
  assembly_.reset();
  const auto files = std::exchange(added_, {});
  const auto named = [&](ModelFileKind kind) -> std::optional<NamedBytes> {
    const auto& added = files[static_cast<std::size_t>(kind)];
    if (!added) return std::nullopt;
    return NamedBytes{added->buffer.bytes(), added->name};
  };
  OwnModelFiles own;
  own.body = named(ModelFileKind::body);
  own.soft_tissue = named(ModelFileKind::soft_tissue);
  own.prior = named(ModelFileKind::prior);
  if (!own.body && !own.soft_tissue && !own.prior) {
    own_.reset();
    learnt_.clear();
    return;
  }
  auto assembly = std::make_unique<OwnModels>(bundled_, own, execution);
  const nlohmann::json kept = nlohmann::json::parse(known, nullptr, false);
  if (kept.is_object()) {
    const auto text = kept.find(assembly->body().sha256);
    if (text != kept.end() && text->is_string())
      assembly->set_learnt(landmarks_from_json(text->get<std::string>(), "the landmarks that were kept"));
  }
  assembly_ = std::move(assembly);
}

std::optional<NetworkRequest> ModelShelf::next_request() {
  if (!assembly_) return std::nullopt;
  if (auto request = assembly_->next_request()) return request;
  learnt_ = assembly_->learnt() ? landmarks_to_json(*assembly_->learnt()) : std::string();
  own_ = std::make_unique<Models>(assembly_->take());
  assembly_.reset();
  return std::nullopt;
}

void ModelShelf::accept(const NetworkReply& reply) {
  if (!assembly_) throw Error(ErrorCode::internal, "no model is being looked at");
  assembly_->accept(reply);
}

std::string ModelShelf::report() const {
  const BodyModel& body = models().body;
  nlohmann::json landmarks;
  if (!learnt_.empty()) landmarks = {{"sha256", body.sha256}, {"text", learnt_}};
  return text_of({{"name", body.name},
                  {"family", body.family},
                  {"vertices", body.vertex_count()},
                  {"betas", body.shape_count()},
                  {"joints", body.joint_count()},
                  {"sha256", body.sha256},
                  {"own", own_ != nullptr},
                  {"landmarks", landmarks}});
}

}  // namespace vitruvian::wasm
