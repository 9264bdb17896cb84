#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/numpy_array.h"

namespace vitruvian {

/// Reads a NumPy .npy file: f2 f4 f8, i1..i8, u1..u8 and b1, either byte order, C or Fortran order.
/// @throws Error(bad_file) when damaged; Error(unsupported_format) for text, complex or Python objects.
NumericArray read_npy(std::span<const std::byte> bytes, const std::string& file_name);

/// A NumPy .npz file (a zip of .npy files, stored or deflated). Only the directory is read at once; an array
/// is unpacked, checked against its CRC-32 and decoded when it is asked for, so members of other kinds do no
/// harm.
class NpzFile {
 public:
  /// @param bytes  the whole file; must outlive the object.
  /// @throws Error(bad_file) when it is no zip, damaged, or larger than 4 GiB.
  NpzFile(std::span<const std::byte> bytes, std::string file_name);

  /// Names without .npy, in the file's order.
  std::vector<std::string> names() const;
  bool has(std::string_view name) const;
  /// @throws Error(bad_file, unsupported_format); also when there is none of that name.
  NumericArray array(std::string_view name) const;
  /// The unpacked content of a member, whatever it is.
  std::vector<std::byte> bytes(std::string_view name) const;
  /// The pickle inside of an array of Python objects; empty for arrays of another kind.
  std::vector<std::byte> python_object(std::string_view name) const;
  /// A single piece of text (numpy types U and S), as UTF-8, zeros at the end removed.
  std::string text(std::string_view name) const;

 private:
  struct Member {
    std::string name;
    bool deflated;
    std::uint32_t crc;
    std::size_t size;
    std::span<const std::byte> stored;
  };
  std::vector<std::byte> unpack(std::string_view name) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string file_name_;
  std::vector<Member> members_;
};

/// One array to write; refers to the caller's data. Exactly one of the spans has the product of `shape`
/// values, or there is one piece of text.
struct NpzItem {
  std::string name;
  std::vector<std::size_t> shape;
  std::span<const float> floats = {};
  std::span<const double> doubles = {};
  std::span<const std::int32_t> integers = {};
  std::string_view text = {};  ///< ASCII, not empty; `shape` is empty then
};

/// The bytes of a .npz file (stored, no time stamps: equal content gives equal bytes). numpy.load() reads it.
/// @throws Error(internal) when an item's shape does not match its data, or the file would reach 4 GiB.
std::string to_npz(std::span<const NpzItem> items);

}  // namespace vitruvian
