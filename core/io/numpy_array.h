#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vitruvian {

/// A numeric array as read from a file: values in C order, integers and booleans as numbers.
struct NumericArray {
  std::vector<std::size_t> shape;  ///< empty for a single number
  std::vector<double> values;
};

/// How NumPy stores one element.
struct NumpyType {
  char kind = 0;  ///< f, i, u, b; U, S, O, V and others are no numbers
  std::size_t item_size = 0;
  bool swap = false;  ///< big-endian

  /// Reads "<f8", "f8", "|b1" ...; the kind is 0 when it is no such text.
  static NumpyType parse(std::string_view text);
};

/// Decodes the elements of an array.
/// @param data  at least as many bytes as the shape needs.
/// @param name  shown in errors.
/// @throws Error(bad_file) when the data are too short; Error(unsupported_format) for text, complex numbers
/// or Python objects.
NumericArray decode_numpy(const NumpyType& type, std::vector<std::size_t> shape, bool fortran_order,
                          std::span<const std::byte> data, const std::string& name);

}  // namespace vitruvian
