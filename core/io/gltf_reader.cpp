#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/binary.h"
#include "io/readers.h"
#include "io/scan_builder.h"

namespace vitruvian {
namespace {

using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorCode::bad_file, what); }

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

/// A non-negative whole number of an object, or none.
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

/// Element `index` of the top-level array `name`.
const Json& item(const Json& document, const char* name, std::size_t index) {
  const auto found = document.find(name);
  if (found == document.end() || !found->is_array() || index >= found->size()) {
    fail(std::string("there is no ") + name + "[" + std::to_string(index) + "]");
  }
  return (*found)[index];
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

class GltfReader {
 public:
  GltfReader(ScanFormat format, const Json& document, std::optional<std::span<const std::byte>> binary_chunk,
             std::size_t file_size, const Execution& execution)
      : document_(document),
        binary_chunk_(binary_chunk),
        file_size_(file_size),
        builder_(format, "triangle", execution) {}

  Scan read() {
    if (!document_.is_object()) fail("the glTF JSON is not an object");
    visit_scene();
    if (skipped_lines_ > 0)
      builder_.add_note(counted(skipped_lines_, "line primitive", "line primitives") + " left out");
    if (skinned_) builder_.add_note("skinned mesh read as modelled, without its skeleton");
    Scan scan = builder_.finish();
    scan.metres_per_unit = 1.0;
    return scan;
  }

 private:
  struct Visit {
    std::size_t node;
    Mat4d scan_from_parent;
  };

  void visit_scene() {
    const std::size_t node_count = array_size("nodes");
    std::vector<Visit> stack;
    std::vector<bool> seen(node_count);
    const auto push = [&](const Json& owner, const char* key, const Mat4d& scan_from_parent,
                          const std::string& place) {
      const auto list = owner.find(key);
      if (list == owner.end()) return;
      if (!list->is_array()) fail(place + ": '" + key + "' is not a list");
      for (std::size_t k = list->size(); k-- > 0;) {
        const double index = (*list)[k].is_number() ? (*list)[k].get<double>() : -1;
        if (!(index >= 0) || index >= static_cast<double>(node_count))
          fail(place + " names a node that does not exist");
        stack.push_back({static_cast<std::size_t>(index), scan_from_parent});
      }
    };
    if (array_size("scenes") > 0) {
      const std::size_t scene = find_count(document_, "scene", "glTF").value_or(0);
      const Json& object = item(document_, "scenes", scene);
      if (!object.is_object()) fail("the scene is not a JSON object");
      push(object, "nodes", Mat4d::Identity(), numbered("scenes", scene));
    } else {
      for (const std::size_t root : roots(node_count)) stack.push_back({root, Mat4d::Identity()});
    }
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const std::string place = numbered("nodes", visit.node);
      if (seen[visit.node]) fail(place + " occurs twice in the scene");
      seen[visit.node] = true;
      const Json& node = item(document_, "nodes", visit.node);
      const auto mesh = find_count(node, "mesh", place);
      const Mat4d scan_from_node = visit.scan_from_parent * local_transform(node, place);
      if (!scan_from_node.allFinite()) fail(place + ": its transform is not finite");
      if (mesh) {
        // glTF ignores the node's own transform for skinned meshes.
        const bool skinned = node.contains("skin");
        skinned_ = skinned_ || skinned;
        add_mesh(*mesh, skinned ? Mat4d(Mat4d::Identity()) : scan_from_node);
      }
      push(node, "children", scan_from_node, place);
    }
  }

  std::size_t array_size(const char* name) const {
    const auto found = document_.find(name);
    if (found == document_.end()) return 0;
    if (!found->is_array()) fail(std::string("'") + name + "' is not a list");
    return found->size();
  }

  /// Nodes that are nobody's children, last first.
  std::vector<std::size_t> roots(std::size_t node_count) const {
    std::vector<bool> is_child(node_count);
    for (std::size_t n = 0; n < node_count; ++n) {
      const Json& node = item(document_, "nodes", n);
      const auto children = node.is_object() ? node.find("children") : node.end();
      if (!node.is_object() || children == node.end() || !children->is_array()) continue;
      for (const Json& child : *children) {
        const double index = child.is_number() ? child.get<double>() : -1;
        if (index >= 0 && index < static_cast<double>(node_count))
          is_child[static_cast<std::size_t>(index)] = true;
      }
    }
    std::vector<std::size_t> result;
    for (std::size_t n = node_count; n-- > 0;) {
      if (!is_child[n]) result.push_back(n);
    }
    return result;
  }

  static Mat4d local_transform(const Json& node, const std::string& place) {
    Mat4d transform = Mat4d::Identity();
    const std::vector<double> matrix = numbers_of(node, "matrix", 16, place);
    if (!matrix.empty()) return Eigen::Map<const Mat4d>(matrix.data());
    const std::vector<double> translation = numbers_of(node, "translation", 3, place);
    const std::vector<double> rotation = numbers_of(node, "rotation", 4, place);
    const std::vector<double> scale = numbers_of(node, "scale", 3, place);
    if (!rotation.empty()) {
      const Eigen::Quaterniond quaternion(rotation[3], rotation[0], rotation[1], rotation[2]);
      if (!(quaternion.norm() > 1e-6)) fail(place + ": its rotation is not a quaternion");
      transform.topLeftCorner<3, 3>() = quaternion.normalized().toRotationMatrix();
    }
    for (int axis = 0; axis < 3 && !scale.empty(); ++axis) transform.col(axis) *= scale[axis];
    for (int axis = 0; axis < 3 && !translation.empty(); ++axis) transform(axis, 3) = translation[axis];
    return transform;
  }

  void add_mesh(std::size_t mesh_index, const Mat4d& scan_from_node) {
    const std::string mesh_place = numbered("meshes", mesh_index);
    const Json& mesh = item(document_, "meshes", mesh_index);
    if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) {
      fail(mesh_place + " has no primitives");
    }
    std::map<std::size_t, std::size_t> first_vertex_of_accessor;
    const Json& primitives = mesh["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      add_primitive(primitives[p], mesh_place + "." + numbered("primitives", p), scan_from_node,
                    first_vertex_of_accessor);
    }
  }

  void add_primitive(const Json& primitive, const std::string& place, const Mat4d& scan_from_node,
                     std::map<std::size_t, std::size_t>& first_vertex_of_accessor) {
    builder_.check();
    const std::size_t mode = find_count(primitive, "mode", place).value_or(4);
    if (mode > 6) fail(place + ": unknown mode " + std::to_string(mode));
    if (mode >= 1 && mode <= 3) {
      ++skipped_lines_;
      return;
    }
    if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_draco_mesh_compression")) {
      throw Error(ErrorCode::unsupported_format,
                  place + " is compressed with Draco: export the scan without Draco compression");
    }
    if (!primitive.contains("attributes") || !primitive["attributes"].is_object())
      fail(place + " has no attributes");
    const Json& attributes = primitive["attributes"];
    const std::size_t position_accessor = count_of(attributes, "POSITION", place + ".attributes");
    const AccessorView positions = view(position_accessor, "VEC3");
    const auto [known, is_new] =
        first_vertex_of_accessor.try_emplace(position_accessor, builder_.vertex_count());
    const std::size_t first_vertex = known->second;
    if (is_new) add_vertices(positions, attributes, place, scan_from_node);
    if (mode == 0) return;

    std::optional<AccessorView> indices;
    if (const auto accessor = find_count(primitive, "indices", place)) {
      indices = view(*accessor, "SCALAR");
      if (indices->type != Scalar::u8 && indices->type != Scalar::u16 && indices->type != Scalar::u32) {
        fail(place + ": its indices are not unsigned integers");
      }
    }
    const std::size_t corner_count = indices ? indices->count : positions.count;
    const auto corner = [&](std::size_t k) {
      const std::size_t index = indices ? indices->index(k) : k;
      if (index >= positions.count) {
        fail(place + ": index " + std::to_string(index) + " at corner " + std::to_string(k) +
             ", but there are only " + std::to_string(positions.count) + " vertices");
      }
      return static_cast<std::int64_t>(first_vertex + index);
    };
    // A mirroring transform turns the faces inside out; glTF asks to turn them back.
    const bool mirrored = scan_from_node.topLeftCorner<3, 3>().determinant() < 0;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c, bool flip) {
      builder_.add_triangle(corner(a), corner(flip ? c : b), corner(flip ? b : c), builder_.face_count());
      if (builder_.face_count() > file_size_) fail("the scene repeats its meshes too often for a scan");
    };
    if (mode == 4) {
      for (std::size_t k = 0; k + 2 < corner_count; k += 3) add(k, k + 1, k + 2, mirrored);
    } else {
      for (std::size_t k = 2; k < corner_count; ++k) {
        if (mode == 5) add(k - 2, k - 1, k, mirrored != (k % 2 == 1));
        if (mode == 6) add(0, k - 1, k, mirrored);
      }
    }
  }

  void add_vertices(const AccessorView& positions, const Json& attributes, const std::string& place,
                    const Mat4d& scan_from_node) {
    // Every vertex takes at least three bytes, unless meshes are repeated by many nodes.
    if (builder_.vertex_count() + positions.count > file_size_)
      fail("the scene repeats its meshes too often for a scan");
    std::optional<AccessorView> normals, colours;
    if (const auto accessor = find_count(attributes, "NORMAL", place)) normals = view(*accessor, "VEC3");
    if (const auto accessor = find_count(attributes, "COLOR_0", place))
      colours = view(*accessor, "VEC3 or VEC4");
    if ((normals && normals->count != positions.count) || (colours && colours->count != positions.count)) {
      fail(place + ": its attributes differ in length");
    }
    const Mat3d linear = scan_from_node.topLeftCorner<3, 3>();
    const Vec3d translation = scan_from_node.topRightCorner<3, 1>();
    // Cofactors carry normals also through a singular transform, where the inverse does not exist.
    Mat3d normal_from_node;
    for (int c = 0; c < 3; ++c)
      normal_from_node.col(c) = linear.col((c + 1) % 3).cross(linear.col((c + 2) % 3));
    if (linear.determinant() < 0) normal_from_node = -normal_from_node;
    for (std::size_t i = 0; i < positions.count; ++i) {
      if (i % (1 << 15) == 0) builder_.check();
      const Vec3d point =
          linear * Vec3d(positions.number(i, 0), positions.number(i, 1), positions.number(i, 2)) +
          translation;
      builder_.add_vertex(point.x(), point.y(), point.z());
      if (normals) {
        const Vec3d normal =
            (normal_from_node * Vec3d(normals->number(i, 0), normals->number(i, 1), normals->number(i, 2)))
                .normalized();
        builder_.add_normal(normal.x(), normal.y(), normal.z());
      }
      if (colours) {
        const auto channel = [&](std::size_t k) {
          const double value = 255.0 * colours->number(i, k);
          return value > 0 ? static_cast<std::uint8_t>(std::min(value + 0.5, 255.0)) : std::uint8_t{0};
        };
        builder_.add_colour(channel(0), channel(1), channel(2));
      }
    }
  }

  AccessorView view(std::size_t index, const std::string& wanted_type) {
    const std::string place = numbered("accessors", index);
    const Json& accessor = item(document_, "accessors", index);
    const std::size_t count = count_of(accessor, "count", place);
    if (accessor.contains("sparse")) {
      throw Error(ErrorCode::unsupported_format,
                  place + " is sparse: export the scan without sparse accessors (morph targets)");
    }
    const std::string type =
        accessor.contains("type") && accessor["type"].is_string() ? accessor["type"].get<std::string>() : "";
    if (type.empty() || wanted_type.find(type) == std::string::npos)
      fail(place + ": its type is not " + wanted_type);
    const std::size_t components = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
    if (components == 0) fail(place + ": its type is not " + wanted_type);
    const Scalar scalar = component_type(count_of(accessor, "componentType", place), place);
    const bool normalized = accessor.contains("normalized") && accessor["normalized"] == true;

    const std::size_t view_index = count_of(accessor, "bufferView", place);
    const std::string view_place = numbered("bufferViews", view_index);
    const Json& buffer_view = item(document_, "bufferViews", view_index);
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
    const std::size_t offset = find_count(accessor, "byteOffset", place).value_or(0);
    if (stride < element || stride > 65536) fail(view_place + ": impossible byteStride");
    const bool fits = count == 0 || (offset <= view_size && element <= view_size - offset &&
                                     count - 1 <= (view_size - offset - element) / stride);
    if (!fits) fail(place + " reaches beyond its buffer view of " + std::to_string(view_size) + " bytes");
    return {bytes.data() + (count == 0 ? 0 : view_offset + offset),
            count,
            stride,
            components,
            scalar,
            normalized};
  }

  static Scalar component_type(std::size_t code, const std::string& place) {
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

  std::span<const std::byte> buffer(std::size_t index) {
    const std::string place = numbered("buffers", index);
    const Json& object = item(document_, "buffers", index);
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

  static std::vector<std::byte> decode_uri(const Json& uri, const std::string& place) {
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

  const Json& document_;
  std::optional<std::span<const std::byte>> binary_chunk_;
  std::size_t file_size_;
  ScanBuilder builder_;
  std::map<std::size_t, std::vector<std::byte>> decoded_;
  std::size_t skipped_lines_ = 0;
  bool skinned_ = false;
};

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Scan read_glb(std::span<const std::byte> bytes, const Execution& execution) {
  if (bytes.size() < 20) fail("too short for a GLB file: " + std::to_string(bytes.size()) + " bytes");
  const auto version = load<std::uint32_t>(bytes.data() + 4);
  if (version != 2) {
    throw Error(ErrorCode::unsupported_format,
                "byte 4: GLB version " + std::to_string(version) + "; only version 2 is read");
  }
  const std::size_t size = load<std::uint32_t>(bytes.data() + 8);
  if (size > bytes.size()) {
    fail("cut short: " + std::to_string(bytes.size()) + " bytes instead of " + std::to_string(size) +
         ", copy it again");
  }
  std::string_view json;
  std::optional<std::span<const std::byte>> binary;
  for (std::size_t position = 12; position + 8 <= size;) {
    const std::size_t chunk_size = load<std::uint32_t>(bytes.data() + position);
    const auto type = load<std::uint32_t>(bytes.data() + position + 4);
    if (chunk_size > size - position - 8)
      fail("byte " + std::to_string(position) + ": a chunk reaches beyond the file");
    const auto chunk = bytes.subspan(position + 8, chunk_size);
    if (type == 0x4e4f534a && json.empty()) json = as_text(chunk);
    if (type == 0x004e4942 && !binary) binary = chunk;
    position += 8 + chunk_size;
    position += (4 - position % 4) % 4;
  }
  if (json.empty()) fail("has no JSON chunk");
  const Json document = parse_json(json);
  return GltfReader(ScanFormat::glb, document, binary, bytes.size(), execution).read();
}

Scan read_gltf(std::span<const std::byte> bytes, const Execution& execution) {
  const Json document = parse_json(as_text(bytes));
  return GltfReader(ScanFormat::gltf, document, std::nullopt, bytes.size(), execution).read();
}

}  // namespace vitruvian
