#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/npz.h"
#include "io/pickle.h"

namespace vitruvian {

/// The tensors of a PyTorch file (torch.save() since version 1.6): a zip that holds a pickle, data.pkl, and
/// the tensors' numbers as raw members.
class TorchArchive {
 public:
  /// @param bytes  the whole file; must outlive the object.
  /// @throws Error(bad_file, unsupported_format).
  TorchArchive(std::span<const std::byte> bytes, std::string file_name);

  PickleValue root() const { return pickle_->root(); }
  /// A tensor of floats, doubles or halves, in C order.
  /// @throws Error(bad_file, unsupported_format) naming it.
  NumericArray tensor(const PickleValue& value, const std::string& name) const;

 private:
  [[noreturn]] void fail(const std::string& name, const std::string& what) const;

  std::string file_name_;
  NpzFile zip_;
  std::string folder_;  // inside of the zip, with a slash at its end
  std::vector<std::byte> pickle_bytes_;
  std::unique_ptr<PickleFile> pickle_;
  bool big_endian_ = false;
};

}  // namespace vitruvian
