#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/numpy_array.h"
#include "io/pickle.h"

namespace vitruvian {

/// A matrix by its entries; entries at the same place add up.
struct SparseMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<std::uint32_t> row, column;
  std::vector<double> value;
};

/// The numbers of a pickled value: a number, a list of numbers, a NumPy array or scalar (either order, made
/// by _reconstruct or from a protocol 5 buffer inside of the file), a SciPy sparse matrix (made dense), or a
/// chumpy object (Ch: its array; Select: the elements it selects).
/// @param name  what it is, shown in errors with the file's name.
/// @throws Error(bad_file) when damaged; Error(unsupported_format) when it is made by something else, which
/// is named.
NumericArray numeric_array(const PickleValue& value, const std::string& name);

/// A pickled SciPy matrix (csc, csr, coo), or the non-zero entries of anything that numeric_array() reads as
/// a matrix. Errors as there.
SparseMatrix sparse_matrix(const PickleValue& value, const std::string& name);

/// The non-zero entries of a matrix. @throws Error(bad_file) when it has not two axes.
SparseMatrix sparse_from_dense(const NumericArray& array, const std::string& name);

/// Content of text, bytes, or what stands for them in old protocols (_codecs.encode, bytearray).
/// @throws Error(unsupported_format) when the value is none of these.
std::string content_of(const PickleValue& value, const std::string& name);

}  // namespace vitruvian
