#pragma once

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/binary.h"

namespace vitruvian::gltf {

using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& what);

/// "nodes[3]".
std::string numbered(const char* name, std::size_t index);
/// A non-negative whole number of an object, or none. `place` names the object in errors.
std::optional<std::size_t> find_count(const Json& object, const char* key, const std::string& place);
std::size_t count_of(const Json& object, const char* key, const std::string& place);
/// `count` finite numbers of an object; empty when it has no such member.
std::vector<double> numbers_of(const Json& object, const char* key, std::size_t count,
                               const std::string& place);

/// A validated accessor: every element lies inside its buffer.
struct AccessorView {
  const std::byte* data;
  std::size_t count;
  std::size_t stride;
  std::size_t components;
  Scalar type;
  bool normalized;

  double number(std::size_t element, std::size_t component) const {
    const double value = load_number(type, data + element * stride + component * size_of(type));
    if (!normalized) return value;
    switch (type) {
      case Scalar::i8:
        return std::max(value / 127.0, -1.0);
      case Scalar::u8:
        return value / 255.0;
      case Scalar::i16:
        return std::max(value / 32767.0, -1.0);
      case Scalar::u16:
        return value / 65535.0;
      default:
        return value;
    }
  }
  std::size_t index(std::size_t element) const {
    return static_cast<std::size_t>(load_number(type, data + element * stride));
  }
};

/// The JSON of a glTF file and its buffers; everything is checked when it is asked for, nothing is copied but
/// data URIs. All members throw Error(bad_file) for contradictions, Error(unsupported_format) for external or
/// compressed buffers.
class Document {
 public:
  /// @param json           text of the JSON; parsed at once.
  /// @param binary_chunk   of a GLB; must outlive the object.
  Document(std::string_view json, std::optional<std::span<const std::byte>> binary_chunk);

  const Json& root() const { return root_; }
  /// Element `index` of the top-level array `name`.
  const Json& item(const char* name, std::size_t index) const;
  /// Length of a top-level array, 0 when there is none.
  std::size_t array_size(const char* name) const;
  /// @param wanted_type  e.g. "VEC3", or several: "VEC3 or VEC4".
  AccessorView accessor(std::size_t index, const std::string& wanted_type);

 private:
  std::span<const std::byte> buffer(std::size_t index);

  Json root_;
  std::optional<std::span<const std::byte>> binary_chunk_;
  std::map<std::size_t, std::vector<std::byte>> decoded_;
};

}  // namespace vitruvian::gltf
