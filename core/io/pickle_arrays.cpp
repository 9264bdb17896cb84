#include "io/pickle_arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "io/pickle_text.h"

namespace vitruvian {
namespace {

/// Chumpy objects and sparse matrices refer to other arrays, in real files two deep; a file that refers to
/// itself must come to an end, and soon, for each may name three.
constexpr int kDeepest = 4;
constexpr std::size_t kMostAxes = 32;
constexpr double kMostElements = 1e9;
constexpr std::size_t kMostDenseElements = std::size_t{1} << 26;

[[noreturn]] void bad(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::bad_file, name + ": " + what);
}

[[noreturn]] void unsupported(const PickleValue& value, const std::string& name) {
  const std::string made_by = value.class_name();
  throw Error(ErrorCode::unsupported_format,
              name + ": is " + (made_by.empty() ? "no array" : "a " + made_by + ", not an array") +
                  "; save it as a plain NumPy array (numpy.savez)");
}

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// NumPy 2 calls its inner package numpy._core.
bool is_numpy(const std::string& class_name, std::string_view function) {
  return class_name.compare(0, 6, "numpy.") == 0 && ends_with(class_name, "." + std::string(function));
}

std::size_t whole(const PickleValue& value, double most, const std::string& name) {
  const std::optional<double> number = value.number();
  if (!number || !(*number >= 0 && *number <= most) || *number != std::floor(*number))
    bad(name, "an array's size or index is not a whole number");
  return static_cast<std::size_t>(*number);
}

std::vector<std::size_t> shape_of(const PickleValue& value, const std::string& name) {
  // A single number stands for one axis.
  if (value.number()) return {whole(value, kMostElements, name)};
  if (value.kind() != PickleKind::list || value.size() > kMostAxes) bad(name, "an array's shape is damaged");
  std::vector<std::size_t> shape;
  for (std::size_t k = 0; k < value.size(); ++k) shape.push_back(whole(value.at(k), kMostElements, name));
  return shape;
}

NumpyType type_of(const PickleValue& value, const std::string& name) {
  if (value.class_name() != "numpy.dtype" || value.arguments().size() < 1)
    bad(name, "an array's type is missing");
  NumpyType type = NumpyType::parse(value.arguments().at(0).text());
  const PickleValue state = value.state();
  if (state.kind() == PickleKind::list && state.size() > 1) type.swap = state.at(1).text() == ">";
  if (type.kind == 0) bad(name, "an array's type is damaged");
  return type;
}

/// Bytes of an array, without a copy where the file holds them as they are.
struct Content {
  std::string owned;
  std::string_view view;
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(view.data(), view.size())); }
};

Content raw_content(const PickleValue& value, const std::string& name) {
  Content content;
  if (value.kind() == PickleKind::text || value.kind() == PickleKind::bytes) {
    content.view = value.text();
  } else {
    content.owned = content_of(value, name);
    content.view = content.owned;
  }
  return content;
}

NumericArray reconstructed(const PickleValue& value, const std::string& name) {
  const PickleValue state = value.state();
  if (state.kind() != PickleKind::list || state.size() < 4) bad(name, "an array has no content");
  const std::size_t first = state.size() == 4 ? 0 : 1;  // the oldest have no version
  const PickleValue fortran = state.at(first + 2), raw = state.at(first + 3);
  if (raw.kind() == PickleKind::list) {
    throw Error(ErrorCode::unsupported_format,
                name + ": holds Python objects; save plain numeric arrays (numpy.savez)");
  }
  const Content content = raw_content(raw, name);
  return decode_numpy(type_of(state.at(first + 1), name), shape_of(state.at(first), name),
                      fortran.number().value_or(0) != 0, content.bytes(), name);
}

NumericArray from_buffer(const PickleValue& value, const std::string& name) {
  const PickleValue arguments = value.arguments();
  if (arguments.size() < 3) bad(name, "an array has no content");
  if (arguments.at(0).kind() == PickleKind::persistent) {
    bad(name, "its numbers are not in the file (out-of-band buffers); save it with protocol 4 or less");
  }
  const bool fortran = arguments.size() > 3 && arguments.at(3).text() == "F";
  const Content content = raw_content(arguments.at(0), name);
  return decode_numpy(type_of(arguments.at(1), name), shape_of(arguments.at(2), name), fortran,
                      content.bytes(), name);
}

NumericArray scalar(const PickleValue& value, const std::string& name) {
  const PickleValue arguments = value.arguments();
  if (arguments.size() < 2) bad(name, "a number has no content");
  const Content content = raw_content(arguments.at(1), name);
  return decode_numpy(type_of(arguments.at(0), name), {}, false, content.bytes(), name);
}

NumericArray list_of_numbers(const PickleValue& value, const std::string& name) {
  NumericArray array;
  array.shape = {value.size()};
  for (std::size_t k = 0; k < value.size(); ++k) {
    const std::optional<double> number = value.at(k).number();
    if (!number) unsupported(value.at(k), name);
    array.values.push_back(*number);
  }
  return array;
}

NumericArray read_array(const PickleValue& value, const std::string& name, int depth);

/// Elements of `a` at flat indices `idxs`, in the shape `preferred_shape` (chumpy.reordering.Select).
NumericArray selected(const PickleValue& value, const std::string& name, int depth) {
  const auto source = value.find("a"), indices = value.find("idxs"), shape = value.find("preferred_shape");
  if (!source || !indices) bad(name, "a chumpy selection is incomplete");
  const NumericArray all = read_array(*source, name, depth + 1);
  const NumericArray places = read_array(*indices, name, depth + 1);
  NumericArray result;
  result.shape = {places.values.size()};
  result.values.reserve(places.values.size());
  for (const double place : places.values) {
    if (!(place >= 0 && place < static_cast<double>(all.values.size())) || place != std::floor(place))
      bad(name, "a chumpy selection points beyond its array");
    result.values.push_back(all.values[static_cast<std::size_t>(place)]);
  }
  if (!shape || shape->is_none()) return result;
  std::vector<std::size_t> wanted = shape_of(*shape, name);
  double count = 1;
  for (const std::size_t extent : wanted) count *= static_cast<double>(extent);
  if (count != static_cast<double>(result.values.size())) bad(name, "a chumpy selection's shape is damaged");
  result.shape = std::move(wanted);
  return result;
}

bool is_sparse(const PickleValue& value) {
  const std::string name = value.class_name();
  return name.compare(0, 13, "scipy.sparse.") == 0;
}

std::vector<std::uint32_t> indices_of(const PickleValue& value, std::string_view key, std::size_t below,
                                      const std::string& name, int depth) {
  const auto found = value.find(key);
  if (!found) bad(name, "a sparse matrix has no " + std::string(key));
  const NumericArray array = read_array(*found, name, depth + 1);
  std::vector<std::uint32_t> indices;
  indices.reserve(array.values.size());
  for (const double index : array.values) {
    if (!(index >= 0 && index < static_cast<double>(below)) || index != std::floor(index))
      bad(name, "a sparse matrix has an index out of range in " + std::string(key));
    indices.push_back(static_cast<std::uint32_t>(index));
  }
  return indices;
}

/// Rows (or columns) of entries from the places where each begins.
std::vector<std::uint32_t> unfolded(const std::vector<std::uint32_t>& begins, std::size_t entries,
                                    std::size_t lines, const std::string& name) {
  bool sound = begins.size() == lines + 1 && begins.front() == 0 && begins.back() == entries;
  for (std::size_t k = 0; sound && k < lines; ++k) sound = begins[k] <= begins[k + 1];
  if (!sound) bad(name, "a sparse matrix has a damaged indptr");
  std::vector<std::uint32_t> line(entries);
  for (std::size_t k = 0; k < lines; ++k)
    std::fill(line.begin() + begins[k], line.begin() + begins[k + 1], static_cast<std::uint32_t>(k));
  return line;
}

SparseMatrix read_sparse(const PickleValue& value, const std::string& name, int depth) {
  const std::string kind = value.class_name();
  auto shape = value.find("_shape");
  if (!shape) shape = value.find("shape");
  const auto data = value.find("data");
  if (!shape || !data) bad(name, "a sparse matrix is incomplete");
  const std::vector<std::size_t> extents = shape_of(*shape, name);
  if (extents.size() != 2) bad(name, "a sparse matrix has not two axes");
  SparseMatrix matrix;
  matrix.rows = extents[0];
  matrix.columns = extents[1];
  matrix.value = read_array(*data, name, depth + 1).values;
  const std::size_t entries = matrix.value.size();
  const bool by_column = kind.find(".csc_") != std::string::npos,
             by_row = kind.find(".csr_") != std::string::npos;
  if (by_column || by_row) {
    std::vector<std::uint32_t> inner =
        indices_of(value, "indices", by_column ? matrix.rows : matrix.columns, name, depth);
    std::vector<std::uint32_t> outer = unfolded(indices_of(value, "indptr", entries + 1, name, depth),
                                                entries, by_column ? matrix.columns : matrix.rows, name);
    if (by_column) std::swap(inner, outer);
    matrix.row = std::move(outer);
    matrix.column = std::move(inner);
  } else if (kind.find(".coo_") != std::string::npos) {
    matrix.row = indices_of(value, "row", matrix.rows, name, depth);
    matrix.column = indices_of(value, "col", matrix.columns, name, depth);
  } else {
    unsupported(value, name);
  }
  if (matrix.row.size() != entries || matrix.column.size() != entries)
    bad(name, "a sparse matrix's arrays differ in length");
  return matrix;
}

NumericArray dense(const SparseMatrix& matrix, const std::string& name) {
  if (matrix.rows != 0 && matrix.columns > kMostDenseElements / matrix.rows)
    bad(name, "a sparse matrix is too large");
  NumericArray array;
  array.shape = {matrix.rows, matrix.columns};
  array.values.assign(matrix.rows * matrix.columns, 0);
  for (std::size_t k = 0; k < matrix.value.size(); ++k)
    array.values[matrix.row[k] * matrix.columns + matrix.column[k]] += matrix.value[k];
  return array;
}

NumericArray read_array(const PickleValue& value, const std::string& name, int depth) {
  if (depth > kDeepest) bad(name, "objects refer to each other too deeply");
  if (const std::optional<double> number = value.number()) return {{}, {*number}};
  if (value.kind() == PickleKind::list) return list_of_numbers(value, name);
  if (value.kind() != PickleKind::object) unsupported(value, name);
  const std::string made_by = value.class_name();
  if (is_numpy(made_by, "_reconstruct") || made_by == "numpy.ndarray") return reconstructed(value, name);
  if (is_numpy(made_by, "_frombuffer")) return from_buffer(value, name);
  if (is_numpy(made_by, "scalar")) return scalar(value, name);
  if (is_sparse(value)) return dense(read_sparse(value, name, depth), name);
  if (made_by.compare(0, 7, "chumpy.") == 0) {
    if (value.find("idxs")) return selected(value, name, depth);
    if (const auto array = value.find("x")) return read_array(*array, name, depth + 1);
  }
  unsupported(value, name);
}

}  // namespace

NumericArray numeric_array(const PickleValue& value, const std::string& name) {
  return read_array(value, name, 0);
}

SparseMatrix sparse_from_dense(const NumericArray& array, const std::string& name) {
  if (array.shape.size() != 2) bad(name, "is not a matrix");
  SparseMatrix matrix;
  matrix.rows = array.shape[0];
  matrix.columns = array.shape[1];
  for (std::size_t k = 0; k < array.values.size(); ++k) {
    if (array.values[k] == 0) continue;
    matrix.row.push_back(static_cast<std::uint32_t>(k / matrix.columns));
    matrix.column.push_back(static_cast<std::uint32_t>(k % matrix.columns));
    matrix.value.push_back(array.values[k]);
  }
  return matrix;
}

SparseMatrix sparse_matrix(const PickleValue& value, const std::string& name) {
  if (value.kind() == PickleKind::object && is_sparse(value)) return read_sparse(value, name, 0);
  return sparse_from_dense(numeric_array(value, name), name);
}

std::string content_of(const PickleValue& value, const std::string& name) {
  if (value.kind() == PickleKind::text || value.kind() == PickleKind::bytes) return std::string(value.text());
  const std::string made_by = value.class_name();
  if (value.kind() == PickleKind::object && value.arguments().kind() == PickleKind::list) {
    const PickleValue arguments = value.arguments();
    const bool plain = ends_with(made_by, "builtin__.bytes") || ends_with(made_by, "builtins.bytes") ||
                       ends_with(made_by, "builtin__.bytearray") || ends_with(made_by, "builtins.bytearray");
    if (plain && arguments.size() == 0) return {};
    if (plain && arguments.size() == 1 && arguments.at(0).kind() == PickleKind::bytes)
      return std::string(arguments.at(0).text());
    if ((plain || made_by == "_codecs.encode") && arguments.size() == 2 &&
        arguments.at(0).kind() == PickleKind::text &&
        (arguments.at(1).text() == "latin1" || arguments.at(1).text() == "latin-1")) {
      if (auto bytes = latin1_from_utf8(arguments.at(0).text())) return std::move(*bytes);
      bad(name, "bytes that were saved as text are damaged");
    }
  }
  unsupported(value, name);
}

}  // namespace vitruvian
