#include "smpl/smpl_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/sha256.h"
#include "smpl/families.h"
#include "smpl/model_arrays.h"

namespace vitruvian {
namespace {

constexpr std::size_t kMostVertices = 200'000, kMostFaces = 400'000, kMostColumns = 2'000;
constexpr int kDefaultBetas = 16;
constexpr std::size_t kSmplxShapeColumns = 300, kSmallSmplxShapeColumns = 10;
constexpr double kLeastWeight = 1e-7;
constexpr double kDmplDeviation = 0.003;  // m
constexpr int kHandNumbers = 45, kHandComponents = 12;

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text = "[";
  for (std::size_t k = 0; k < shape.size(); ++k) text += (k ? ", " : "") + std::to_string(shape[k]);
  return text + "]";
}

/// Reads one file; the model grows as its arrays are read.
class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& file_name) : arrays_(bytes, file_name) {
    model.sha256 = to_hex(sha256(bytes));
    const std::size_t slash = file_name.find_last_of("/\\");
    model.name = slash == std::string::npos ? file_name : file_name.substr(slash + 1);
    if (const std::size_t dot = model.name.rfind('.'); dot != std::string::npos && dot > 0)
      model.name.resize(dot);
    model.gender = gender_from_path(file_name);
  }

  BodyModel read(const SmplOptions& options) {
    read_mesh();
    read_tree();
    read_pose_correctives();
    read_shape(options);
    read_weights();
    read_regressor();
    read_hands();
    finish_model(model);
    add_star_column();
    make_priors();
    return std::move(model);
  }

 private:
  NumericArray array(const char* key, const std::vector<std::size_t>& expected) const {
    NumericArray result = arrays_.array(key);
    if (result.shape != expected) wrong_shape(key, result.shape, shape_text(expected));
    return result;
  }
  [[noreturn]] void wrong_shape(const std::string& key, const std::vector<std::size_t>& shape,
                                const std::string& wanted) const {
    arrays_.fail(key + ": has the shape " + shape_text(shape) + ", " + wanted + " is expected");
  }
  /// V x 3 x n, or the same flattened to 3V x n. Returns n.
  std::size_t columns_of(const std::string& key, const std::vector<std::size_t>& shape) const {
    const bool cube = shape.size() == 3 && shape[0] == vertices_ && shape[1] == 3;
    const bool flat = shape.size() == 2 && shape[0] == 3 * vertices_;
    if ((!cube && !flat) || shape.back() < 1 || shape.back() > kMostColumns)
      wrong_shape(key, shape, "[" + std::to_string(vertices_) + ", 3, n]");
    return shape.back();
  }

  void read_mesh() {
    const NumericArray v = arrays_.array("v_template");
    if (v.shape.size() != 2 || v.shape[1] != 3 || v.shape[0] < 4 || v.shape[0] > kMostVertices)
      wrong_shape("v_template", v.shape, "[V, 3]");
    vertices_ = v.shape[0];
    model.v_template =
        Eigen::Map<const Points3d>(v.values.data(), 3, static_cast<Index>(vertices_)).cast<float>();
    const double extent =
        (model.v_template.rowwise().maxCoeff() - model.v_template.rowwise().minCoeff()).maxCoeff();
    if (!(extent > 0.3 && extent < 4))
      arrays_.fail("v_template: spans " + std::to_string(extent) + " m; a body in metres is expected");

    const NumericArray f = arrays_.array("f");
    if (f.shape.size() != 2 || f.shape[1] != 3 || f.shape[0] < 4 || f.shape[0] > kMostFaces)
      wrong_shape("f", f.shape, "[F, 3]");
    model.faces.resize(3, static_cast<Index>(f.shape[0]));
    for (std::size_t i = 0; i < f.values.size(); ++i) {
      if (!(f.values[i] >= 0 && f.values[i] < static_cast<double>(vertices_)))
        arrays_.fail("f: face " + std::to_string(i / 3) + " has a vertex that does not exist");
      model.faces.data()[i] = static_cast<std::int32_t>(f.values[i]);
    }
  }

  void read_tree() {
    const NumericArray tree = arrays_.array("kintree_table");
    if (tree.shape.size() != 2 || tree.shape[0] != 2 || tree.shape[1] < 1 || tree.shape[1] > kMostJoints)
      wrong_shape("kintree_table", tree.shape, "[2, joints]");
    const std::size_t joints = tree.shape[1];
    model.parent.assign(joints, -1);
    for (std::size_t j = 1; j < joints; ++j) {
      const double parent = tree.values[j];
      if (!(parent >= 0 && parent < static_cast<double>(j)))
        arrays_.fail("kintree_table: joint " + std::to_string(j) + " has an impossible parent");
      model.parent[j] = static_cast<int>(parent);
    }
  }

  void read_pose_correctives() {
    NumericArray posedirs = arrays_.array("posedirs");
    const std::size_t columns = columns_of("posedirs", posedirs.shape);
    const std::optional<SmplFamily> family = smpl_family(model.parent.size(), columns);
    if (!family) {
      arrays_.fail("has " + std::to_string(model.parent.size()) + " joints and " + std::to_string(columns) +
                   " pose correctives; known are SMPL (24, 207), STAR (24, 93), SMPL+H (52, 459) and SMPL-X "
                   "(55, 486)");
    }
    family_ = *family;
    model.family = family_.name;
    model.joint_names = joint_names(family_);
    const bool star = family_.name == "star";
    model.pose_feature = star ? PoseFeature::quaternion : PoseFeature::rotation;
    const std::size_t width = star ? 4 : 9;
    model.corrective_begin.assign(1, 0);
    for (std::size_t v = 0; v < vertices_; ++v) {
      for (std::size_t j = 1; j < model.parent.size(); ++j) {
        Eigen::Matrix<float, 3, 9> block = Eigen::Matrix<float, 3, 9>::Zero();
        for (std::size_t c = 0; c < 3; ++c) {
          const double* row = posedirs.values.data() + (3 * v + c) * columns + width * (j - 1);
          for (std::size_t k = 0; k < width; ++k)
            block(static_cast<Index>(c), static_cast<Index>(k)) = static_cast<float>(row[k]);
        }
        if ((block.array() == 0).all()) continue;
        model.corrective_joint.push_back(static_cast<int>(j));
        model.corrective.push_back(block);
      }
      model.corrective_begin.push_back(static_cast<int>(model.corrective.size()));
    }
    if (star) {
      star_column_.resize(static_cast<Index>(3 * vertices_));
      for (std::size_t i = 0; i < 3 * vertices_; ++i)
        star_column_[static_cast<Index>(i)] = static_cast<float>(posedirs.values[i * columns + columns - 1]);
    }
  }

  void read_shape(const SmplOptions& options) {
    const NumericArray dirs = arrays_.array("shapedirs");
    const std::size_t columns = columns_of("shapedirs", dirs.shape);
    std::size_t shapes = columns, expressions = 0;
    if (family_.jaw >= 0) {
      shapes = columns > kSmplxShapeColumns ? kSmplxShapeColumns : std::min(columns, kSmallSmplxShapeColumns);
      expressions = columns - shapes;
      if (options.expressions >= 0) expressions = std::min<std::size_t>(expressions, options.expressions);
    }
    if (options.betas > static_cast<int>(shapes)) {
      throw Error(ErrorCode::usage, "--betas " + std::to_string(options.betas) + ": " + arrays_.file_name() +
                                        " has only " + std::to_string(shapes));
    }
    std::size_t used = std::min<std::size_t>(shapes, kDefaultBetas);
    if (options.betas > 0) used = static_cast<std::size_t>(options.betas);
    if (options.betas == kEveryBeta) used = shapes;
    model.expression_count = static_cast<int>(expressions);
    model.shapedirs.resize(static_cast<Index>(3 * vertices_), static_cast<Index>(used + expressions));
    for (std::size_t i = 0; i < 3 * vertices_; ++i) {
      for (std::size_t k = 0; k < used + expressions; ++k) {
        const std::size_t column = k < used ? k : shapes + k - used;
        model.shapedirs(static_cast<Index>(i), static_cast<Index>(k)) =
            static_cast<float>(dirs.values[i * columns + column]);
      }
    }
  }

  void read_weights() {
    const std::size_t joints = model.parent.size();
    const NumericArray weights = array("weights", {vertices_, joints});
    std::vector<std::vector<std::pair<double, int>>> rows(vertices_);
    std::size_t most = 1;
    model.segment.resize(vertices_);
    for (std::size_t v = 0; v < vertices_; ++v) {
      double sum = 0;
      std::array<double, 24> by_segment{};
      for (std::size_t j = 0; j < joints; ++j) {
        const double weight = weights.values[v * joints + j];
        if (std::abs(weight) > 2) arrays_.fail("weights: vertex " + std::to_string(v) + " has one beyond 1");
        if (std::abs(weight) < kLeastWeight) continue;
        rows[v].emplace_back(weight, static_cast<int>(j));
        by_segment[static_cast<std::size_t>(segment_of_joint(family_, static_cast<int>(j)))] += weight;
        sum += weight;
      }
      if (!(std::abs(sum - 1) < 0.01))
        arrays_.fail("weights: those of vertex " + std::to_string(v) + " sum to " + std::to_string(sum) +
                     ", not 1");
      for (auto& [weight, joint] : rows[v]) weight /= sum;
      // Learnt weights may be a little below 0; largest first all the same, as zeros end a vertex's list.
      std::stable_sort(rows[v].begin(), rows[v].end(),
                       [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
      most = std::max(most, rows[v].size());
      model.segment[v] = static_cast<std::uint8_t>(std::max_element(by_segment.begin(), by_segment.end()) -
                                                   by_segment.begin());
    }
    model.skin_joint = Eigen::MatrixXi::Zero(static_cast<Index>(most), static_cast<Index>(vertices_));
    model.skin_weight = Eigen::MatrixXf::Zero(static_cast<Index>(most), static_cast<Index>(vertices_));
    for (std::size_t v = 0; v < vertices_; ++v) {
      for (std::size_t k = 0; k < rows[v].size(); ++k) {
        model.skin_weight(static_cast<Index>(k), static_cast<Index>(v)) =
            static_cast<float>(rows[v][k].first);
        model.skin_joint(static_cast<Index>(k), static_cast<Index>(v)) = rows[v][k].second;
      }
    }
  }

  void read_regressor() {
    const SparseMatrix regressor = arrays_.matrix("J_regressor");
    const std::size_t joints = model.parent.size();
    if (regressor.rows != joints || regressor.columns != vertices_)
      wrong_shape("J_regressor", {regressor.rows, regressor.columns}, shape_text({joints, vertices_}));
    std::vector<double> sum(joints, 0.0);
    std::vector<std::size_t> order(regressor.value.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    // The same order of summation however the file stores them.
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(regressor.row[a], regressor.column[a]) <
             std::pair(regressor.row[b], regressor.column[b]);
    });
    for (const std::size_t k : order) {
      model.regressor.push_back({static_cast<int>(regressor.row[k]), static_cast<int>(regressor.column[k]),
                                 static_cast<float>(regressor.value[k])});
      sum[regressor.row[k]] += regressor.value[k];
    }
    for (std::size_t j = 0; j < joints; ++j) {
      if (!(std::abs(sum[j] - 1) < 0.1)) {
        arrays_.fail("J_regressor: the weights of joint " + std::to_string(j) + " sum to " +
                     std::to_string(sum[j]) + ", not 1");
      }
    }
  }

  /// Hand poses, where the file has them (merged from MANO): hands_meanl, hands_componentsl, hands_coeffsl.
  void read_hands() {
    if (family_.first_left_finger < 0) return;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::string suffix = side == 0 ? "l" : "r";
      if (!arrays_.has("hands_components" + suffix) || !arrays_.has("hands_mean" + suffix)) continue;
      HandPoses& hand = model.hands[side];
      const NumericArray mean = arrays_.array("hands_mean" + suffix);
      const NumericArray components = arrays_.array("hands_components" + suffix);
      if (mean.values.size() != kHandNumbers) wrong_shape("hands_mean" + suffix, mean.shape, "[45]");
      if (components.shape.size() != 2 || components.shape[1] != kHandNumbers || components.shape[0] < 1)
        wrong_shape("hands_components" + suffix, components.shape, "[n, 45]");
      const auto used = static_cast<Index>(std::min<std::size_t>(components.shape[0], kHandComponents));
      hand.mean = Eigen::Map<const Eigen::VectorXd>(mean.values.data(), kHandNumbers);
      hand.components = Eigen::Map<const Eigen::MatrixXd>(components.values.data(), kHandNumbers, used);
      hand.deviation = Eigen::VectorXd::Ones(used);
      // Components need not have unit length; the deviation takes it over.
      for (Index k = 0; k < used; ++k) {
        const double length = hand.components.col(k).norm();
        if (!(length > 1e-9)) arrays_.fail("hands_components" + suffix + ": one of them is zero");
        hand.components.col(k) /= length;
        hand.deviation[k] = length;
      }
      read_hand_deviation("hands_coeffs" + suffix, hand);
    }
  }

  void read_hand_deviation(const std::string& key, HandPoses& hand) const {
    if (!arrays_.has(key)) return;
    const NumericArray coefficients = arrays_.array(key);
    const auto used = hand.deviation.size();
    if (coefficients.shape.size() != 2 || coefficients.shape[0] < 2 ||
        coefficients.shape[1] < static_cast<std::size_t>(used))
      wrong_shape(key, coefficients.shape, "[samples, components]");
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const RowMajor> all(coefficients.values.data(),
                                         static_cast<Index>(coefficients.shape[0]),
                                         static_cast<Index>(coefficients.shape[1]));
    for (Index k = 0; k < used; ++k) {
      const Eigen::VectorXd column = all.col(k);
      const double spread = std::sqrt((column.array() - column.mean()).square().mean());
      if (spread > 1e-6) hand.deviation[k] *= spread;
    }
  }

  void add_star_column() {
    if (star_column_.size() > 0 && model.shapedirs.cols() > 1) model.shapedirs.col(1) += star_column_;
  }

  void make_priors() {
    for (ShapePrior& prior : model.priors) {
      prior.mean = Eigen::VectorXd::Zero(model.beta_count());
      prior.precision = Eigen::MatrixXd::Identity(model.beta_count(), model.beta_count());
    }
  }

  ModelArrays arrays_;
  BodyModel model;
  SmplFamily family_;
  std::size_t vertices_ = 0;
  Eigen::VectorXf star_column_;
};

}  // namespace

BodyModel read_smpl_model(std::span<const std::byte> bytes, const std::string& file_name,
                          const SmplOptions& options) {
  return Reader(bytes, file_name).read(options);
}

void add_dmpl(BodyModel& model, std::span<const std::byte> bytes, const std::string& file_name,
              int components) {
  if (model.family != "smpl" && model.family != "smplh") {
    throw Error(ErrorCode::usage, file_name + ": soft tissue (--dmpl) goes with SMPL or SMPL+H, not with " +
                                      model.name + " (" + model.family +
                                      "): give the body model it belongs to before it or together with it");
  }
  const ModelArrays arrays(bytes, file_name);
  const NumericArray dirs = arrays.array("eigvec");
  const auto vertices = static_cast<std::size_t>(model.vertex_count());
  if (dirs.shape.size() != 3 || dirs.shape[0] != vertices || dirs.shape[1] != 3 || dirs.shape[2] < 1 ||
      dirs.shape[2] > kMostColumns) {
    arrays.fail("eigvec: has the shape " + shape_text(dirs.shape) + "; for " + model.name + " [" +
                std::to_string(vertices) + ", 3, n] is expected");
  }
  const auto count =
      static_cast<Index>(std::min<std::size_t>(dirs.shape[2], static_cast<std::size_t>(components)));
  const Index before = model.shapedirs.cols();
  model.shapedirs.conservativeResize(Eigen::NoChange, before + count);
  Eigen::VectorXd precision(count);
  for (Index k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < 3 * vertices; ++i)
      model.shapedirs(static_cast<Index>(i), before + k) =
          static_cast<float>(dirs.values[i * dirs.shape[2] + static_cast<std::size_t>(k)]);
    const double moved = model.shapedirs.col(before + k).norm() / std::sqrt(static_cast<double>(vertices));
    if (!(moved > 0)) arrays.fail("eigvec: component " + std::to_string(k) + " is zero");
    precision[k] = moved * moved / (kDmplDeviation * kDmplDeviation);
  }
  model.dmpl_count = static_cast<int>(count);
  finish_model(model);
  for (ShapePrior& prior : model.priors) {
    prior.mean.conservativeResize(before + count);
    prior.mean.tail(count).setZero();
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(before + count, before + count);
    full.topLeftCorner(before, before) = prior.precision;
    full.bottomRightCorner(count, count) = precision.asDiagonal();
    prior.precision = std::move(full);
  }
}

}  // namespace vitruvian
