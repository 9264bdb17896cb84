#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vitruvian {

/// Reader of our own container for numeric arrays (default body, pose prior). Format: models/README.md,
/// "Array file".
///
/// Everything is validated before use: magic, version, kind, size, SHA-256, every offset, shape and encoding;
/// sizes are checked against the file's own before anything is allocated.
class ArrayFile {
 public:
  /// @param bytes  the whole file; must outlive the object.
  /// @param kind   four characters, e.g. "BODY".
  /// @param name   shown in errors.
  /// @throws Error(bad_model) naming the file and what is wrong.
  ArrayFile(std::span<const std::byte> bytes, std::string_view kind, std::string name);

  bool has(std::string_view array) const;
  /// Shape of an array; throws Error(bad_model) when there is none of that name.
  std::vector<std::size_t> shape(std::string_view array) const;

  /// The array as float in C order; integers are multiplied by the companion array `<name>.scale` if there is
  /// one (one value, or one for each index of the first axis). NaN and infinity are refused.
  std::vector<float> floats(std::string_view array, std::span<const std::size_t> expected_shape) const;
  /// The array as int32 in C order; each value must be in [low, high].
  std::vector<std::int32_t> integers(std::string_view array, std::span<const std::size_t> expected_shape,
                                     std::int32_t low, std::int32_t high) const;
  /// A rank-1 u8 array as text.
  std::string text(std::string_view array) const;

 private:
  enum class Type : std::uint32_t {
    u8 = 0,
    i8 = 1,
    u16 = 2,
    i16 = 3,
    u32 = 4,
    i32 = 5,
    f16 = 6,
    f32 = 7,
    f64 = 8
  };
  struct Entry {
    std::string name;
    Type type;
    std::vector<std::size_t> shape;
    std::size_t count;
    bool compressed;
    std::span<const std::byte> payload;
  };

  const Entry& find(std::string_view array) const;
  /// The array's raw little-endian elements, decompressed and unshuffled.
  std::vector<std::byte> elements(const Entry& entry) const;
  std::vector<double> values(const Entry& entry) const;
  const Entry& checked(std::string_view array, std::span<const std::size_t> expected_shape) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string name_;
  std::vector<Entry> entries_;
};

}  // namespace vitruvian
