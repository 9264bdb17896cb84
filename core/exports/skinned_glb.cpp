#include "exports/skinned_glb.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kVertices = 34962, kIndices = 34963;

/// Collects the binary chunk and its accessors.
class GlbParts {
 public:
  template <typename T>
  int add(const std::vector<T>& values, std::size_t count, const char* type, int component, int target = 0) {
    while (binary_.size() % 4 != 0) binary_.push_back('\0');
    ordered_json view = {
        {"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (target != 0) view["target"] = target;
    binary_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    views_.push_back(view);
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    return static_cast<int>(accessors_.size()) - 1;
  }
  ordered_json& accessor(int index) { return accessors_[static_cast<std::size_t>(index)]; }

  /// The whole file; `document` gets the buffers.
  std::string file(ordered_json document) {
    while (binary_.size() % 4 != 0) binary_.push_back('\0');
    document["bufferViews"] = views_;
    document["accessors"] = accessors_;
    document["buffers"] = ordered_json::array({{{"byteLength", binary_.size()}}});
    std::string text = document.dump();
    while (text.size() % 4 != 0) text.push_back(' ');
    std::string out = "glTF";
    append(out, 2);
    append(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary_.size()));
    append(out, static_cast<std::uint32_t>(text.size()));
    out += "JSON" + text;
    append(out, static_cast<std::uint32_t>(binary_.size()));
    out += std::string("BIN\0", 4) + binary_;
    return out;
  }

 private:
  static void append(std::string& out, std::uint32_t value) {
    char raw[4];
    std::memcpy(raw, &value, 4);
    out.append(raw, 4);
  }

  std::string binary_;
  ordered_json views_ = ordered_json::array(), accessors_ = ordered_json::array();
};

ordered_json vector_json(const Vec3d& v) { return {v[0], v[1], v[2]}; }

std::vector<float> floats_of(const Points3d& points) {
  const Points3f rounded = points.cast<float>();
  return {rounded.data(), rounded.data() + rounded.size()};
}

void add_bounds(ordered_json& accessor, const Points3f& points) {
  const Vec3f low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  accessor["min"] = {low[0], low[1], low[2]};
  accessor["max"] = {high[0], high[1], high[2]};
}

/// JOINTS_n and WEIGHTS_n of four influences each, as many as the model has.
void add_skin(const BodyModel& model, GlbParts& parts, ordered_json& attributes) {
  const Index per_vertex = model.skin_joint.rows(), count = model.vertex_count();
  for (Index first = 0; first < per_vertex; first += 4) {
    std::vector<std::uint16_t> joints(static_cast<std::size_t>(4 * count), 0);
    std::vector<float> weights(static_cast<std::size_t>(4 * count), 0);
    for (Index v = 0; v < count; ++v) {
      for (Index k = first; k < std::min(per_vertex, first + 4); ++k) {
        if (model.skin_weight(k, v) == 0) continue;
        const auto i = static_cast<std::size_t>(4 * v + k - first);
        joints[i] = static_cast<std::uint16_t>(model.skin_joint(k, v));
        weights[i] = model.skin_weight(k, v);
      }
    }
    const std::string set = std::to_string(first / 4);
    attributes["JOINTS_" + set] =
        parts.add(joints, static_cast<std::size_t>(count), "VEC4", kUnsignedShort, kVertices);
    attributes["WEIGHTS_" + set] =
        parts.add(weights, static_cast<std::size_t>(count), "VEC4", kFloat, kVertices);
  }
}

}  // namespace

std::string to_skinned_glb(const ExportedBody& body) {
  const BodyModel& model = body.model;
  const Skeleton skeleton = pose_skeleton(model, body.state);
  VertexMatrix<double> rest;
  shape_vertices(model, body.state.betas, rest);
  if (body.rest_offsets.cols() == rest.cols()) rest += body.rest_offsets;
  add_correctives(model, body.state, rest);

  GlbParts parts;
  const std::vector<float> positions = floats_of(rest);
  const auto count = static_cast<std::size_t>(model.vertex_count());
  const int position = parts.add(positions, count, "VEC3", kFloat, kVertices);
  add_bounds(parts.accessor(position), rest.cast<float>());
  ordered_json attributes = {{"POSITION", position}};
  add_skin(model, parts, attributes);
  const std::vector<std::uint32_t> indices(model.faces.data(), model.faces.data() + model.faces.size());
  const int index = parts.add(indices, indices.size(), "SCALAR", kUnsignedInt, kIndices);

  const int joints = model.joint_count();
  std::vector<float> inverse_bind;
  ordered_json nodes = ordered_json::array({{{"name", "body"}, {"mesh", 0}, {"skin", 0}}});
  ordered_json skin_joints = ordered_json::array(), channels = ordered_json::array(),
               samplers = ordered_json::array();
  // Two keys at one pose: a pose to look at from the first frame on, in importers that want a duration too.
  const int times = parts.add(std::vector<float>{0, 1}, 2, "SCALAR", kFloat);
  parts.accessor(times)["min"] = {0};
  parts.accessor(times)["max"] = {1};
  for (int j = 0; j < joints; ++j) {
    const int parent = model.parent[static_cast<std::size_t>(j)];
    const Vec3d rest_joint = skeleton.rest_joints.col(j);
    const Vec3d place = parent < 0 ? Vec3d(rest_joint + body.state.translation)
                                   : Vec3d(rest_joint - skeleton.rest_joints.col(parent));
    Eigen::Quaterniond turn(body.state.rotation[static_cast<std::size_t>(j)]);
    turn.normalize();
    ordered_json node = {{"name", model.joint_names[static_cast<std::size_t>(j)]},
                         {"translation", vector_json(place)},
                         {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}};
    ordered_json children = ordered_json::array();
    for (int c = j + 1; c < joints; ++c) {
      if (model.parent[static_cast<std::size_t>(c)] == j) children.push_back(c + 1);
    }
    if (!children.empty()) node["children"] = children;
    if (parent < 0) {
      const Mat4d scan_from_body = body.body_from_scan.inverse();
      ordered_json numbers = ordered_json::array();
      for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) numbers.push_back(scan_from_body(r, c));
      }
      node["extras"] = {{"scan_from_glb", numbers}};
    }
    nodes.push_back(node);
    skin_joints.push_back(j + 1);
    Eigen::Matrix4f bind = Eigen::Matrix4f::Identity();
    bind.topRightCorner<3, 1>() = -rest_joint.cast<float>();
    inverse_bind.insert(inverse_bind.end(), bind.data(), bind.data() + 16);
    std::vector<float> keys;
    for (int key = 0; key < 2; ++key) {
      for (const double c : {turn.x(), turn.y(), turn.z(), turn.w()}) keys.push_back(static_cast<float>(c));
    }
    samplers.push_back(
        {{"input", times}, {"interpolation", "LINEAR"}, {"output", parts.add(keys, 2, "VEC4", kFloat)}});
    channels.push_back(
        {{"sampler", samplers.size() - 1}, {"target", {{"node", j + 1}, {"path", "rotation"}}}});
  }

  ordered_json document;
  document["asset"] = {{"version", "2.0"}, {"generator", "Vitruvian"}};
  document["scene"] = 0;
  document["scenes"] = ordered_json::array({{{"nodes", {0, 1}}}});
  document["nodes"] = nodes;
  ordered_json primitive = {{"attributes", attributes}, {"indices", index}, {"material", 0}};
  document["meshes"] =
      ordered_json::array({{{"name", "body"}, {"primitives", ordered_json::array({primitive})}}});
  document["materials"] =
      ordered_json::array({{{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}}});
  document["skins"] = ordered_json::array(
      {{{"joints", skin_joints},
        {"skeleton", 1},
        {"inverseBindMatrices", parts.add(inverse_bind, static_cast<std::size_t>(joints), "MAT4", kFloat)}}});
  document["animations"] =
      ordered_json::array({{{"name", "pose"}, {"channels", channels}, {"samplers", samplers}}});
  return parts.file(std::move(document));
}

}  // namespace vitruvian
