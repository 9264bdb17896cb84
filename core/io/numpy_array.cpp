#include "io/numpy_array.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "base/error.h"
#include "io/binary.h"

namespace vitruvian {
namespace {

double half_at(const std::byte* bytes, bool swap) {
  const auto half = load<std::uint16_t>(bytes, swap);
  const int exponent = half >> 10 & 31, fraction = half & 1023;
  double magnitude = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  if (exponent == 31)
    magnitude = fraction ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
  return half & 0x8000 ? -magnitude : magnitude;
}

/// Elements one after another, in the file's order.
std::vector<double> decode(const NumpyType& type, std::size_t count, const std::byte* data,
                           const std::string& name) {
  std::vector<double> values(count);
  const auto is = [&](char kind, std::size_t size) { return type.kind == kind && type.item_size == size; };
  const auto all = [&](Scalar scalar) {
    for (std::size_t i = 0; i < count; ++i)
      values[i] = load_number(scalar, data + i * type.item_size, type.swap);
  };
  if (is('f', 4)) {
    all(Scalar::f32);
  } else if (is('f', 8)) {
    all(Scalar::f64);
  } else if (is('i', 1)) {
    all(Scalar::i8);
  } else if (is('i', 2)) {
    all(Scalar::i16);
  } else if (is('i', 4)) {
    all(Scalar::i32);
  } else if (is('i', 8)) {
    all(Scalar::i64);
  } else if (is('u', 1) || is('b', 1)) {
    all(Scalar::u8);
  } else if (is('u', 2)) {
    all(Scalar::u16);
  } else if (is('u', 4)) {
    all(Scalar::u32);
  } else if (is('u', 8)) {
    all(Scalar::u64);
  } else if (is('f', 2)) {
    for (std::size_t i = 0; i < count; ++i) values[i] = half_at(data + 2 * i, type.swap);
  } else if (type.kind == 'O') {
    throw Error(ErrorCode::unsupported_format, name + ": holds Python objects; save plain numeric arrays");
  } else {
    throw Error(ErrorCode::unsupported_format,
                name + ": NumPy type " + (type.kind ? std::string(1, type.kind) : std::string("?")) +
                    std::to_string(type.item_size) + " is not a plain number");
  }
  return values;
}

/// Fortran order to C order.
std::vector<double> transposed(const std::vector<double>& values, const std::vector<std::size_t>& shape) {
  std::vector<double> result(values.size());
  std::vector<std::size_t> index(shape.size());
  for (double& value : result) {
    std::size_t position = 0;
    for (std::size_t k = shape.size(); k-- > 0;) position = position * shape[k] + index[k];
    value = values[position];
    for (std::size_t k = shape.size(); k-- > 0;) {
      if (++index[k] < shape[k]) break;
      index[k] = 0;
    }
  }
  return result;
}

}  // namespace

NumpyType NumpyType::parse(std::string_view text) {
  NumpyType type;
  if (!text.empty() && (text[0] == '<' || text[0] == '>' || text[0] == '|' || text[0] == '=')) {
    type.swap = text[0] == '>';
    text.remove_prefix(1);
  }
  if (text.empty()) return {};
  type.kind = text[0];
  for (std::size_t k = 1; k < text.size() && text[k] >= '0' && text[k] <= '9' && type.item_size < 1'000'000;
       ++k) {
    type.item_size = 10 * type.item_size + static_cast<std::size_t>(text[k] - '0');
  }
  if (type.kind == 'U') type.item_size *= 4;
  return type;
}

NumericArray decode_numpy(const NumpyType& type, std::vector<std::size_t> shape, bool fortran_order,
                          std::span<const std::byte> data, const std::string& name) {
  std::size_t count = 1;
  bool too_short = false;
  for (const std::size_t extent : shape) {
    // Each element takes at least a byte, so the product cannot overflow before the data are too short.
    too_short = too_short || (extent != 0 && count > data.size() / extent);
    count = too_short ? 0 : count * extent;
  }
  if (too_short || (type.item_size != 0 && count > data.size() / type.item_size)) {
    throw Error(ErrorCode::bad_file, name + ": is cut short: its shape does not fit its size");
  }
  NumericArray array;
  array.values = decode(type, count, data.data(), name);
  if (fortran_order && shape.size() > 1) array.values = transposed(array.values, shape);
  array.shape = std::move(shape);
  return array;
}

}  // namespace vitruvian
