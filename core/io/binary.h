#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace vitruvian {

/// The number of type T stored at `bytes`, which need not be aligned. The core's targets are all
/// little-endian, so `swap` is true for big-endian data.
template <class T>
T load(const std::byte* bytes, bool swap = false) {
  std::byte raw[sizeof(T)];
  std::memcpy(raw, bytes, sizeof raw);
  if (swap) std::reverse(raw, raw + sizeof raw);
  T value;
  std::memcpy(&value, raw, sizeof value);
  return value;
}

/// Scalar types of the binary formats.
enum class Scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64, i64, u64 };

constexpr std::size_t size_of(Scalar type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8, 8, 8};
  return sizes[static_cast<std::size_t>(type)];
}

inline double load_number(Scalar type, const std::byte* bytes, bool swap = false) {
  switch (type) {
    case Scalar::i8:
      return load<std::int8_t>(bytes);
    case Scalar::u8:
      return load<std::uint8_t>(bytes);
    case Scalar::i16:
      return load<std::int16_t>(bytes, swap);
    case Scalar::u16:
      return load<std::uint16_t>(bytes, swap);
    case Scalar::i32:
      return load<std::int32_t>(bytes, swap);
    case Scalar::u32:
      return load<std::uint32_t>(bytes, swap);
    case Scalar::f32:
      return load<float>(bytes, swap);
    case Scalar::f64:
      return load<double>(bytes, swap);
    case Scalar::i64:
      return static_cast<double>(load<std::int64_t>(bytes, swap));
    case Scalar::u64:
      return static_cast<double>(load<std::uint64_t>(bytes, swap));
  }
  return 0;
}

}  // namespace vitruvian
