#include "io/gltf_document.h"

#include <limits>

#include "base/error.h"

namespace vitruvian::gltf {
namespace {

/// Refuses JSON that is deeper or has more values than any real glTF file, before a tree is built from it.
void check_json_size(std::string_view text) {
  constexpr int kDeepest = 100;
  constexpr std::size_t kMostValues = 4'000'000;
  int depth = 0;
  std::size_t values = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '[' || c == '{') ++depth, ++values;
    if (c == ']' || c == '}') --depth;
    if (c == ',') ++values;
    if (depth > kDeepest || values > kMostValues)
      fail("the glTF JSON is deeper or larger than any real scan's");
  }
}

Json parse_json(std::string_view text) {
  check_json_size(text);
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::exception& error) {
    fail(std::string("the glTF JSON cannot be read: ") + error.what());
  }
}

std::vector<std::byte> decode_base64(std::string_view text, const std::string& place) {
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    std::uint32_t value;
    if (c >= 'A' && c <= 'Z') {
      value = c - 'A';
    } else if (c >= 'a' && c <= 'z') {
      value = c - 'a' + 26;
    } else if (c >= '0' && c <= '9') {
      value = c - '0' + 52;
    } else if (c == '+' || c == '-') {
      value = 62;
    } else if (c == '/' || c == '_') {
      value = 63;
    } else if (c == '=') {
      break;
    } else {
      fail(place + ": its data URI is not base64");
    }
    bits = bits << 6 | value;
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> bit_count & 255));
    }
  }
  return bytes;
}

std::vector<std::byte> decode_uri(const Json& uri, const std::string& place) {
  if (!uri.is_string()) fail(place + ": its uri is not text");
  const auto& text = uri.get_ref<const std::string&>();
  const std::size_t comma = text.find(',');
  if (text.rfind("data:", 0) != 0 || comma == std::string::npos) {
    throw Error(ErrorCode::unsupported_format, place + " is in another file, '" + text.substr(0, 80) +
                                                   "': export the scan as one .glb file");
  }
  if (text.rfind(";base64", comma) == std::string::npos) fail(place + ": its data URI is not base64");
  return decode_base64(std::string_view(text).substr(comma + 1), place);
}

Scalar component_type(std::size_t code, const std::string& place) {
  switch (code) {
    case 5120:
      return Scalar::i8;
    case 5121:
      return Scalar::u8;
    case 5122:
      return Scalar::i16;
    case 5123:
      return Scalar::u16;
    case 5125:
      return Scalar::u32;
    case 5126:
      return Scalar::f32;
    default:
      fail(place + ": unknown componentType " + std::to_string(code));
  }
}

}  // namespace

void fail(const std::string& what) { throw Error(ErrorCode::bad_file, what); }

std::optional<std::size_t> find_count(const Json& object, const char* key, const std::string& place) {
  if (!object.is_object()) fail(place + " is not a JSON object");
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  const double value = found->is_number() ? found->get<double>() : -1;
  if (!(value >= 0) || value > 4503599627370496.0 || value != std::floor(value) ||
      value > static_cast<double>(std::numeric_limits<std::size_t>::max())) {
    fail(place + ": '" + key + "' is not a count or an index");
  }
  return static_cast<std::size_t>(value);
}

std::size_t count_of(const Json& object, const char* key, const std::string& place) {
  const auto value = find_count(object, key, place);
  if (!value) fail(place + " has no '" + key + "'");
  return *value;
}

std::string numbered(const char* name, std::size_t index) {
  return std::string(name) + "[" + std::to_string(index) + "]";
}

std::vector<double> numbers_of(const Json& object, const char* key, std::size_t count,
                               const std::string& place) {
  std::vector<double> values;
  const auto found = object.find(key);
  if (found == object.end()) return values;
  if (!found->is_array() || found->size() != count)
    fail(place + ": '" + key + "' needs " + std::to_string(count) + " numbers");
  for (const Json& value : *found) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail(place + ": '" + key + "' is not made of numbers");
    values.push_back(value.get<double>());
  }
  return values;
}

Document::Document(std::string_view json, std::optional<std::span<const std::byte>> binary_chunk)
    : root_(parse_json(json)), binary_chunk_(binary_chunk) {
  if (!root_.is_object()) fail("the glTF JSON is not an object");
}

const Json& Document::item(const char* name, std::size_t index) const {
  const auto found = root_.find(name);
  if (found == root_.end() || !found->is_array() || index >= found->size()) {
    fail(std::string("there is no ") + name + "[" + std::to_string(index) + "]");
  }
  return (*found)[index];
}

std::size_t Document::array_size(const char* name) const {
  const auto found = root_.find(name);
  if (found == root_.end()) return 0;
  if (!found->is_array()) fail(std::string("'") + name + "' is not a list");
  return found->size();
}

AccessorView Document::accessor(std::size_t index, const std::string& wanted_type) {
  const std::string place = numbered("accessors", index);
  const Json& object = item("accessors", index);
  const std::size_t count = count_of(object, "count", place);
  if (object.contains("sparse")) {
    throw Error(ErrorCode::unsupported_format,
                place + " is sparse: export the scan without sparse accessors (morph targets)");
  }
  const std::string type =
      object.contains("type") && object["type"].is_string() ? object["type"].get<std::string>() : "";
  if (type.empty() || wanted_type.find(type) == std::string::npos)
    fail(place + ": its type is not " + wanted_type);
  const std::size_t components = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
  if (components == 0) fail(place + ": its type is not " + wanted_type);
  const Scalar scalar = component_type(count_of(object, "componentType", place), place);
  const bool normalized = object.contains("normalized") && object["normalized"] == true;

  const std::size_t view_index = count_of(object, "bufferView", place);
  const std::string view_place = numbered("bufferViews", view_index);
  const Json& buffer_view = item("bufferViews", view_index);
  const std::size_t view_size = count_of(buffer_view, "byteLength", view_place);
  if (buffer_view.contains("extensions") && buffer_view["extensions"].contains("EXT_meshopt_compression")) {
    throw Error(ErrorCode::unsupported_format,
                view_place + " is compressed with meshopt: export the scan without compression");
  }
  const std::size_t view_offset = find_count(buffer_view, "byteOffset", view_place).value_or(0);
  const std::span<const std::byte> bytes = buffer(count_of(buffer_view, "buffer", view_place));
  if (view_offset > bytes.size() || view_size > bytes.size() - view_offset) {
    fail(view_place + " reaches beyond its buffer of " + std::to_string(bytes.size()) +
         " bytes: the file is cut short or damaged");
  }
  const std::size_t element = components * size_of(scalar);
  const std::size_t stride = find_count(buffer_view, "byteStride", view_place).value_or(element);
  const std::size_t offset = find_count(object, "byteOffset", place).value_or(0);
  if (stride < element || stride > 65536) fail(view_place + ": impossible byteStride");
  const bool fits = count == 0 || (offset <= view_size && element <= view_size - offset &&
                                   count - 1 <= (view_size - offset - element) / stride);
  if (!fits) fail(place + " reaches beyond its buffer view of " + std::to_string(view_size) + " bytes");
  return {
      bytes.data() + (count == 0 ? 0 : view_offset + offset), count, stride, components, scalar, normalized};
}

std::span<const std::byte> Document::buffer(std::size_t index) {
  const std::string place = numbered("buffers", index);
  const Json& object = item("buffers", index);
  const std::size_t size = count_of(object, "byteLength", place);
  std::span<const std::byte> bytes;
  const auto uri = object.find("uri");
  if (uri == object.end()) {
    if (index != 0 || !binary_chunk_) fail(place + " has no data");
    bytes = *binary_chunk_;
  } else {
    const auto [known, is_new] = decoded_.try_emplace(index);
    if (is_new) known->second = decode_uri(*uri, place);
    bytes = known->second;
  }
  if (size > bytes.size()) {
    fail(place + " announces " + std::to_string(size) + " bytes but has " + std::to_string(bytes.size()) +
         ": the file is cut short or damaged");
  }
  return bytes.first(size);
}

}  // namespace vitruvian::gltf
