#include <algorithm>

#include "io/pickle.h"

namespace vitruvian {

PickleKind PickleValue::kind() const { return file_->nodes_[index_].kind; }

std::optional<double> PickleValue::number() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind != PickleKind::boolean && node.kind != PickleKind::integer && node.kind != PickleKind::real)
    return std::nullopt;
  return node.number;
}

std::string_view PickleValue::text() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  return node.kind == PickleKind::text || node.kind == PickleKind::bytes ? node.text : std::string_view();
}

std::size_t PickleValue::size() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind == PickleKind::object) return node.appended.size();
  return node.kind == PickleKind::list ? node.items.size() : 0;
}

PickleValue PickleValue::at(std::size_t index) const {
  const PickleFile::Node& node = file_->nodes_[index_];
  return {*file_, node.kind == PickleKind::object ? node.appended[index] : node.items[index]};
}

std::optional<PickleValue> PickleValue::find(std::string_view key) const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind != PickleKind::dictionary && node.kind != PickleKind::object) return std::nullopt;
  // Of keys that come twice Python keeps the last.
  for (std::size_t k = node.items.size(); k >= 2; k -= 2) {
    const PickleFile::Node& name = file_->nodes_[node.items[k - 2]];
    if ((name.kind == PickleKind::text || name.kind == PickleKind::bytes) && name.text == key)
      return PickleValue(*file_, node.items[k - 1]);
  }
  if (node.kind != PickleKind::object) return std::nullopt;
  const PickleValue kept = state();
  if (kept.kind() == PickleKind::dictionary) return kept.find(key);
  // Objects with slots keep a pair of dictionaries.
  for (std::size_t k = 0; kept.kind() == PickleKind::list && k < std::min<std::size_t>(2, kept.size()); ++k) {
    if (kept.at(k).kind() != PickleKind::dictionary) continue;
    if (const auto found = kept.at(k).find(key)) return found;
  }
  return std::nullopt;
}

std::vector<std::string> PickleValue::keys() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  std::vector<std::string> names;
  if (node.kind != PickleKind::dictionary && node.kind != PickleKind::object) return names;
  for (std::size_t k = 0; k + 1 < node.items.size(); k += 2) {
    const PickleFile::Node& name = file_->nodes_[node.items[k]];
    if (name.kind == PickleKind::text || name.kind == PickleKind::bytes) names.emplace_back(name.text);
  }
  return names;
}

std::string PickleValue::class_name() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind == PickleKind::global) return std::string(node.module) + "." + std::string(node.text);
  if (node.kind != PickleKind::object) return {};
  const PickleFile::Node& callable = file_->nodes_[node.callable];
  if (callable.kind != PickleKind::global) return {};
  // How old protocols say "an empty object of this class".
  if (callable.text == "_reconstructor" || callable.text == "__newobj__" ||
      callable.text == "__newobj_ex__") {
    const PickleFile::Node& given = file_->nodes_[node.arguments];
    if (given.kind == PickleKind::list && !given.items.empty()) {
      const PickleValue first(*file_, given.items[0]);
      if (first.kind() == PickleKind::global) return first.class_name();
    }
  }
  return std::string(callable.module) + "." + std::string(callable.text);
}

PickleValue PickleValue::arguments() const { return {*file_, file_->nodes_[index_].arguments}; }
PickleValue PickleValue::state() const { return {*file_, file_->nodes_[index_].state}; }

}  // namespace vitruvian
