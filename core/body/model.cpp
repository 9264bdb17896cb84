#include "body/model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/array_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw Error(ErrorCode::bad_model, file + ": " + what);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

void read_skin(const ArrayFile& file, const std::string& name, BodyModel& model) {
  const std::size_t vertices = model.v_template.cols();
  const auto shape = file.shape("skin_joint");
  if (shape.size() != 2 || shape[1] < 1 || shape[1] > 16) fail(name, "skin_joint must have 1 to 16 columns");
  const std::size_t per_vertex = shape[1];
  const std::size_t expected[] = {vertices, per_vertex};
  const auto joints = file.integers("skin_joint", expected, 0, model.joint_count() - 1);
  const auto weights = file.integers("skin_weight", expected, 0, 65535);
  model.skin_joint.resize(per_vertex, vertices);
  model.skin_weight.resize(per_vertex, vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    std::vector<std::pair<float, int>> row(per_vertex);
    float sum = 0;
    for (std::size_t k = 0; k < per_vertex; ++k) {
      row[k] = {static_cast<float>(weights[v * per_vertex + k]), joints[v * per_vertex + k]};
      sum += row[k].first;
    }
    if (!(sum > 0)) fail(name, "vertex " + std::to_string(v) + " has no skinning weight");
    std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t k = 0; k < per_vertex; ++k) {
      model.skin_weight(k, v) = row[k].first / sum;
      model.skin_joint(k, v) = row[k].second;
    }
  }
}

void read_correctives(const ArrayFile& file, const std::string& name, BodyModel& model) {
  const int vertices = model.vertex_count();
  model.corrective_begin.assign(vertices + 1, 0);
  if (!file.has("corrective")) return;
  const auto shape = file.shape("corrective");
  const std::size_t blocks = shape[0];
  const std::size_t flat[] = {blocks}, full[] = {blocks, 27};
  const auto vertex = file.integers("corrective_vertex", flat, 0, vertices - 1);
  const auto joint = file.integers("corrective_joint", flat, 1, model.joint_count() - 1);
  const auto values = file.floats("corrective", full);
  model.corrective_joint.assign(joint.begin(), joint.end());
  model.corrective.resize(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    if (b > 0 && std::pair(vertex[b - 1], joint[b - 1]) >= std::pair(vertex[b], joint[b])) {
      fail(name, "corrective blocks are not sorted by vertex and joint at block " + std::to_string(b));
    }
    ++model.corrective_begin[vertex[b] + 1];
    model.corrective[b] =
        Eigen::Map<const Eigen::Matrix<float, 3, 9, Eigen::RowMajor>>(values.data() + 27 * b);
  }
  for (int v = 0; v < vertices; ++v) model.corrective_begin[v + 1] += model.corrective_begin[v];
}

void read_regressor(const ArrayFile& file, const std::string& name, BodyModel& model) {
  const auto shape = file.shape("regressor_joint");
  const std::size_t flat[] = {shape[0]};
  const auto joint = file.integers("regressor_joint", flat, 0, model.joint_count() - 1);
  const auto vertex = file.integers("regressor_vertex", flat, 0, model.vertex_count() - 1);
  const auto weight = file.floats("regressor_weight", flat);
  std::vector<double> sum(model.joint_count(), 0.0);
  for (std::size_t i = 0; i < shape[0]; ++i) {
    model.regressor.push_back({joint[i], vertex[i], weight[i]});
    sum[joint[i]] += weight[i];
  }
  for (int j = 0; j < model.joint_count(); ++j) {
    if (std::abs(sum[j] - 1) > 1e-3)
      fail(name, "regressor weights of joint " + std::to_string(j) + " do not sum to 1");
  }
}

void read_priors(const ArrayFile& file, const std::string& name, BodyModel& model) {
  const std::size_t betas = model.beta_count();
  const std::size_t mean_shape[] = {3, betas}, precision_shape[] = {3, betas, betas};
  const auto mean = file.floats("prior_mean", mean_shape);
  const auto precision = file.floats("prior_precision", precision_shape);
  for (std::size_t g = 0; g < 3; ++g) {
    ShapePrior& prior = model.priors[g];
    prior.mean = Eigen::Map<const Eigen::VectorXf>(mean.data() + g * betas, betas).cast<double>();
    const Eigen::MatrixXd p =
        Eigen::Map<const Eigen::MatrixXf>(precision.data() + g * betas * betas, betas, betas).cast<double>();
    prior.precision = 0.5 * (p + p.transpose());
    if (Eigen::LLT<Eigen::MatrixXd>(prior.precision).info() != Eigen::Success) {
      fail(name, "the shape prior's precision is not positive definite");
    }
  }
}

}  // namespace

const std::array<std::string_view, 24> kSegmentNames = {
    "hips",         "left_upper_leg", "right_upper_leg", "spine",      "left_leg",        "right_leg",
    "spine1",       "left_foot",      "right_foot",      "spine2",     "left_toe_base",   "right_toe_base",
    "neck",         "left_shoulder",  "right_shoulder",  "head",       "left_arm",        "right_arm",
    "left_forearm", "right_forearm",  "left_hand",       "right_hand", "left_hand_index", "right_hand_index"};

const std::array<std::string_view, 24> kSmplJointNames = {
    "pelvis",     "left_hip",    "right_hip",    "spine1",      "left_knee",     "right_knee",
    "spine2",     "left_ankle",  "right_ankle",  "spine3",      "left_foot",     "right_foot",
    "neck",       "left_collar", "right_collar", "head",        "left_shoulder", "right_shoulder",
    "left_elbow", "right_elbow", "left_wrist",   "right_wrist", "left_hand",     "right_hand"};

std::string_view name_of(Gender gender) noexcept {
  switch (gender) {
    case Gender::neutral:
      return "neutral";
    case Gender::female:
      return "female";
    case Gender::male:
      return "male";
  }
  return "neutral";
}

int BodyModel::joint_for_smpl(int smpl_joint) const {
  if (smpl_joint < 22) return smpl_joint;
  const std::string_view wanted[] = {kSmplJointNames[smpl_joint],
                                     smpl_joint == 22 ? "left_middle1" : "right_middle1"};
  for (const std::string_view name : wanted) {
    const auto found = std::find(joint_names.begin(), joint_names.end(), name);
    if (found != joint_names.end()) return static_cast<int>(found - joint_names.begin());
  }
  // Without hands of any kind, the wrist.
  return std::min(smpl_joint - 2, joint_count() - 1);
}

BodyModel read_body_model(std::span<const std::byte> bytes, const std::string& file_name) {
  const ArrayFile file(bytes, "BODY", file_name);
  BodyModel model;
  model.name = "vitruvian-default";
  model.family = "vitruvian";
  model.sha256 = to_hex(sha256(bytes));

  const auto template_shape = file.shape("v_template");
  if (template_shape.size() != 2 || template_shape[1] != 3 || template_shape[0] < 4) {
    fail(file_name, "v_template must be V x 3");
  }
  const std::size_t vertices = template_shape[0];
  const auto v_template = file.floats("v_template", template_shape);
  model.v_template = Eigen::Map<const Points3f>(v_template.data(), 3, vertices);

  const auto shape_shape = file.shape("shapedirs");
  if (shape_shape.size() != 3 || shape_shape[1] != vertices || shape_shape[2] != 3) {
    fail(file_name, "shapedirs must be K x V x 3");
  }
  const auto shapedirs = file.floats("shapedirs", shape_shape);
  model.shapedirs = Eigen::Map<const Eigen::MatrixXf>(shapedirs.data(), 3 * vertices, shape_shape[0]);

  const auto face_shape = file.shape("faces");
  const std::size_t expected_faces[] = {face_shape[0], 3};
  const auto faces = file.integers("faces", expected_faces, 0, static_cast<int>(vertices) - 1);
  model.faces = Eigen::Map<const Faces>(faces.data(), 3, face_shape[0]);

  const auto parent_shape = file.shape("parent");
  model.parent = file.integers("parent", parent_shape, -1, 254);
  if (model.parent.empty() || model.parent.size() > 64) fail(file_name, "a model needs 1 to 64 joints");
  for (int j = 0; j < model.joint_count(); ++j) {
    if ((j == 0) != (model.parent[j] == -1) || model.parent[j] >= j) {
      fail(file_name, "joint " + std::to_string(j) + " has an impossible parent");
    }
  }
  model.joint_names = lines_of(file.text("joint_names"));
  if (model.joint_names.size() != model.parent.size()) fail(file_name, "joint_names and parent disagree");

  read_skin(file, file_name, model);
  read_correctives(file, file_name, model);
  read_regressor(file, file_name, model);
  const std::size_t flat[] = {vertices};
  const auto segment = file.integers("segment", flat, 0, 23);
  model.segment.assign(segment.begin(), segment.end());
  if (file.has("mirror")) {
    model.mirror = file.integers("mirror", flat, 0, static_cast<int>(vertices) - 1);
    for (std::size_t v = 0; v < vertices; ++v) {
      if (model.mirror[model.mirror[v]] != static_cast<int>(v))
        fail(file_name, "mirror is not its own inverse");
    }
  }
  read_priors(file, file_name, model);
  finish_model(model);
  return model;
}

void finish_model(BodyModel& model) {
  const int joints = model.joint_count(), betas = model.beta_count();
  model.joint_template = Points3d::Zero(3, joints);
  model.joint_shapedirs = Eigen::MatrixXd::Zero(3 * joints, betas);
  for (const BodyModel::RegressorEntry& entry : model.regressor) {
    model.joint_template.col(entry.joint) += entry.weight * model.v_template.col(entry.vertex).cast<double>();
    model.joint_shapedirs.middleRows<3>(3 * entry.joint) +=
        entry.weight * model.shapedirs.middleRows<3>(3 * entry.vertex).cast<double>();
  }
  if (model.corrective_begin.empty()) model.corrective_begin.assign(model.vertex_count() + 1, 0);
  model.vertex_area = vertex_areas(model.v_template, model.faces);
}

}  // namespace vitruvian
