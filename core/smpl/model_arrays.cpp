#include "smpl/model_arrays.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

constexpr std::size_t kShownKeys = 20;

bool is_zip(std::span<const std::byte> bytes) {
  return bytes.size() > 4 && bytes[0] == std::byte{'P'} && bytes[1] == std::byte{'K'} &&
         bytes[2] == std::byte{3};
}

/// What an array of Python objects holds when it holds one: how numpy.savez() keeps a sparse matrix.
PickleValue only_object(const PickleFile& pickle) {
  const PickleValue state = pickle.root().state();
  if (state.kind() == PickleKind::list && state.size() > 3) {
    const PickleValue content = state.at(state.size() - 1);
    if (content.kind() == PickleKind::list && content.size() == 1) return content.at(0);
  }
  return pickle.root();
}

}  // namespace

ModelArrays::ModelArrays(std::span<const std::byte> bytes, std::string file_name)
    : file_name_(std::move(file_name)) {
  if (is_zip(bytes)) {
    npz_ = std::make_unique<NpzFile>(bytes, file_name_);
    return;
  }
  // How a pickled dictionary can begin; anything else is another kind of file.
  static constexpr std::string_view kBeginnings = "\x80(}c]";
  if (bytes.empty() || kBeginnings.find(static_cast<char>(bytes[0])) == std::string_view::npos) {
    throw Error(ErrorCode::unsupported_format,
                file_name_ + ": is neither a NumPy archive (.npz) nor a pickle (.pkl)");
  }
  pickle_ = std::make_unique<PickleFile>(bytes, file_name_);
  const PickleKind kind = pickle_->root().kind();
  if (kind != PickleKind::dictionary && kind != PickleKind::object)
    fail("the pickle holds no dictionary of arrays; is it a model file?");
}

bool ModelArrays::has(std::string_view key) const {
  return npz_ ? npz_->has(key) : pickle_->root().find(key).has_value();
}

std::vector<std::string> ModelArrays::keys() const {
  if (npz_) return npz_->names();
  const PickleValue root = pickle_->root();
  std::vector<std::string> names = root.keys();
  if (names.empty() && root.kind() == PickleKind::object) names = root.state().keys();
  return names;
}

void ModelArrays::require(std::string_view key) const {
  if (has(key)) return;
  const std::vector<std::string> names = keys();
  std::string list;
  for (std::size_t k = 0; k < std::min(kShownKeys, names.size()); ++k)
    list += (k ? ", " : "") + names[k].substr(0, 40);
  if (names.size() > kShownKeys) list += " ...";
  fail("has no array '" + std::string(key) + "', only: " + list + "; it is no body model of the SMPL family");
}

NumericArray ModelArrays::array(std::string_view key) const {
  require(key);
  NumericArray array;
  if (pickle_) {
    array = numeric_array(*pickle_->root().find(key), place(key));
  } else if (const std::vector<std::byte> object = npz_->python_object(key); !object.empty()) {
    const PickleFile pickle(object, place(key));
    array = numeric_array(only_object(pickle), place(key));
  } else {
    array = npz_->array(key);
  }
  for (const double value : array.values) {
    if (!std::isfinite(value)) fail(std::string(key) + ": holds a value that is not finite");
  }
  return array;
}

SparseMatrix ModelArrays::matrix(std::string_view key) const {
  require(key);
  SparseMatrix matrix;
  if (pickle_) {
    matrix = sparse_matrix(*pickle_->root().find(key), place(key));
  } else if (const std::vector<std::byte> object = npz_->python_object(key); !object.empty()) {
    const PickleFile pickle(object, place(key));
    matrix = sparse_matrix(only_object(pickle), place(key));
  } else {
    matrix = sparse_from_dense(npz_->array(key), place(key));
  }
  for (const double value : matrix.value) {
    if (!std::isfinite(value)) fail(std::string(key) + ": holds a value that is not finite");
  }
  return matrix;
}

void ModelArrays::fail(const std::string& what) const {
  throw Error(ErrorCode::bad_model, file_name_ + ": " + what);
}

}  // namespace vitruvian
