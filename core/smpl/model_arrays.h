#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/npz.h"
#include "io/pickle.h"
#include "io/pickle_arrays.h"

namespace vitruvian {

/// The arrays of a model file by name, whether it is a NumPy archive (.npz) or a pickle (.pkl); the content
/// tells which, not the file's name.
class ModelArrays {
 public:
  /// @param bytes  the whole file; must outlive the object.
  /// @throws Error(bad_file, unsupported_format).
  ModelArrays(std::span<const std::byte> bytes, std::string file_name);

  bool has(std::string_view key) const;
  std::vector<std::string> keys() const;
  /// @throws Error(bad_model) listing what there is when there is no such array, or when a number is not
  /// finite; Error(bad_file, unsupported_format) when it is damaged or of another kind.
  NumericArray array(std::string_view key) const;
  /// The same of a matrix, which may be stored sparse.
  SparseMatrix matrix(std::string_view key) const;

  const std::string& file_name() const { return file_name_; }
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void require(std::string_view key) const;
  std::string place(std::string_view key) const { return file_name_ + ": " + std::string(key); }

  std::string file_name_;
  std::unique_ptr<NpzFile> npz_;
  std::unique_ptr<PickleFile> pickle_;
};

}  // namespace vitruvian
