#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>  // tinygltf 2.7 uses it without including it when it has no file system
#include <sstream>

#include "base/error.h"
#include "io/mesh_check.h"
#include "io/mesh_writer.h"

// tinygltf without pictures and without a file system: only its writer to a stream is used.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#endif
#include <tiny_gltf.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace vitruvian {
namespace {

class GlbBuilder {
 public:
  template <class T>
  int add_accessor(const std::vector<T>& values, std::size_t count, int type, int component_type,
                   int target) {
    tinygltf::Buffer& buffer = model.buffers[0];
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.data.size();
    view.byteLength = values.size() * sizeof(T);
    view.target = target;
    const auto* raw = reinterpret_cast<const unsigned char*>(values.data());
    buffer.data.insert(buffer.data.end(), raw, raw + view.byteLength);
    model.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
    accessor.componentType = component_type;
    accessor.count = count;
    accessor.type = type;
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
  }

  tinygltf::Model model;
};

std::string upper_case(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

}  // namespace

std::string to_glb(const MeshView& mesh, const Mat4d& body_from_scan) {
  check_mesh(mesh);
  const Mat4d scan_from_body = body_from_scan.inverse();
  if (!body_from_scan.allFinite() || !scan_from_body.allFinite()) {
    throw Error(ErrorCode::internal, "mesh to write: body_from_scan cannot be inverted");
  }
  const Index vertex_count = mesh.vertices.cols();
  Vec3d centre = Vec3d::Zero();
  if (vertex_count > 0)
    centre = 0.5 * (mesh.vertices.rowwise().minCoeff() + mesh.vertices.rowwise().maxCoeff());
  const Points3f local = (mesh.vertices.colwise() - centre).cast<float>();
  Mat4d body_from_local = body_from_scan;
  body_from_local.topRightCorner<3, 1>() += body_from_scan.topLeftCorner<3, 3>() * centre;

  GlbBuilder builder;
  tinygltf::Model& model = builder.model;
  model.asset.version = "2.0";
  model.asset.generator = "Vitruvian";
  model.buffers.emplace_back();
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;

  const std::vector<float> positions(local.data(), local.data() + local.size());
  const auto count = static_cast<std::size_t>(vertex_count);
  const int position = builder.add_accessor(positions, count, TINYGLTF_TYPE_VEC3,
                                            TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
  for (int axis = 0; axis < 3 && vertex_count > 0; ++axis) {
    model.accessors[position].minValues.push_back(local.row(axis).minCoeff());
    model.accessors[position].maxValues.push_back(local.row(axis).maxCoeff());
  }
  primitive.attributes["POSITION"] = position;
  if (!mesh.colours.empty()) {
    std::vector<std::uint8_t> colours(4 * count, 255);
    for (std::size_t v = 0; v < count; ++v)
      std::copy_n(mesh.colours.data() + 3 * v, 3, colours.data() + 4 * v);
    const int colour =
        builder.add_accessor(colours, count, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                             TINYGLTF_TARGET_ARRAY_BUFFER);
    model.accessors[colour].normalized = true;
    primitive.attributes["COLOR_0"] = colour;
  }
  if (!mesh.values.empty()) {
    const std::vector<float> values(mesh.values.begin(), mesh.values.end());
    primitive.attributes["_" + upper_case(mesh.value_name)] = builder.add_accessor(
        values, count, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  const std::vector<std::uint32_t> indices(mesh.faces.data(), mesh.faces.data() + mesh.faces.size());
  primitive.indices =
      builder.add_accessor(indices, indices.size(), TINYGLTF_TYPE_SCALAR,
                           TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  tinygltf::Material material;
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 0.9;
  model.materials.push_back(material);
  primitive.material = 0;

  tinygltf::Mesh gltf_mesh;
  gltf_mesh.name = "registered";
  gltf_mesh.primitives.push_back(primitive);
  model.meshes.push_back(gltf_mesh);
  tinygltf::Node node;
  node.name = "registered";
  node.mesh = 0;
  node.matrix.assign(body_from_local.data(), body_from_local.data() + 16);
  tinygltf::Value::Array scan_from_glb;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) scan_from_glb.emplace_back(scan_from_body(row, column));
  }
  node.extras = tinygltf::Value(tinygltf::Value::Object{{"scan_from_glb", tinygltf::Value(scan_from_glb)}});
  model.nodes.push_back(node);
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes.push_back(scene);
  model.defaultScene = 0;

  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, false, true)) {
    throw Error(ErrorCode::internal, "mesh to write: the GLB could not be put together");
  }
  return stream.str();
}

}  // namespace vitruvian
