#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf_document.h"
#include "io/readers.h"
#include "io/scan_builder.h"

namespace vitruvian {
namespace {

using namespace gltf;

class GltfReader {
 public:
  /// @param file_size  bounds what a scene may repeat.
  GltfReader(ScanFormat format, Document& document, std::size_t file_size, const Execution& execution)
      : document_(document), file_size_(file_size), builder_(format, "triangle", execution) {}

  Scan read() {
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
    const std::size_t node_count = document_.array_size("nodes");
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
    if (document_.array_size("scenes") > 0) {
      const std::size_t scene = find_count(document_.root(), "scene", "glTF").value_or(0);
      const Json& object = document_.item("scenes", scene);
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
      const Json& node = document_.item("nodes", visit.node);
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

  /// Nodes that are nobody's children, last first.
  std::vector<std::size_t> roots(std::size_t node_count) const {
    std::vector<bool> is_child(node_count);
    for (std::size_t n = 0; n < node_count; ++n) {
      const Json& node = document_.item("nodes", n);
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
    const Json& mesh = document_.item("meshes", mesh_index);
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
    const AccessorView positions = document_.accessor(position_accessor, "VEC3");
    const auto [known, is_new] =
        first_vertex_of_accessor.try_emplace(position_accessor, builder_.vertex_count());
    const std::size_t first_vertex = known->second;
    if (is_new) add_vertices(positions, attributes, place, scan_from_node);
    if (mode == 0) return;

    std::optional<AccessorView> indices;
    if (const auto accessor = find_count(primitive, "indices", place)) {
      indices = document_.accessor(*accessor, "SCALAR");
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
    if (const auto accessor = find_count(attributes, "NORMAL", place))
      normals = document_.accessor(*accessor, "VEC3");
    if (const auto accessor = find_count(attributes, "COLOR_0", place))
      colours = document_.accessor(*accessor, "VEC3 or VEC4");
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

  Document& document_;
  std::size_t file_size_;
  ScanBuilder builder_;
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
  Document document(json, binary);
  return GltfReader(ScanFormat::glb, document, bytes.size(), execution).read();
}

Scan read_gltf(std::span<const std::byte> bytes, const Execution& execution) {
  Document document(as_text(bytes), std::nullopt);
  return GltfReader(ScanFormat::gltf, document, bytes.size(), execution).read();
}

}  // namespace vitruvian
