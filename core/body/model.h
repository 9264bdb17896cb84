#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/types.h"

namespace vitruvian {

enum class Gender { neutral = 0, female = 1, male = 2 };
std::string_view name_of(Gender gender) noexcept;

/// Normal distribution of the shape parameters over a population: N(mean, precision^-1).
struct ShapePrior {
  Eigen::VectorXd mean;       ///< K
  Eigen::MatrixXd precision;  ///< K x K, symmetric positive definite
};

/// What pose correctives are multiplied by, for each joint but the root.
enum class PoseFeature {
  rotation,    ///< vec(R - I), row-major, 9 numbers (SMPL)
  quaternion,  ///< (x, y, z, w - 1, 0 ...) with w >= 0, the first 4 of 9 numbers (STAR)
};

/// Poses of one hand as the model's makers measured them; axis-angle numbers of its 15 joints.
struct HandPoses {
  Eigen::VectorXd mean;        ///< 45
  Eigen::MatrixXd components;  ///< 45 x n, orthonormal, most important first
  Eigen::VectorXd deviation;   ///< n, standard deviation along each
};

/// Skinning weights and joints that a model has at most.
inline constexpr int kMostSkinWeights = 64, kMostJoints = 64;

/// A body model of the SMPL form (Loper et al. 2015): template + linear shape + pose correctives, joints from
/// a linear regressor, linear blend skinning. Metres, Y up, facing +Z, left hand on +X. Sizes are free: V
/// vertices, J joints, K linear coefficients, S skinning weights a vertex. The K coefficients are shape, then
/// facial expression, then soft tissue; most of the code calls all of them betas.
struct BodyModel {
  std::string name;
  std::string family;            ///< "vitruvian", "smpl", "smplh", "smplx" or "star"
  std::string sha256;            ///< of the file (or files) it was read from
  std::optional<Gender> gender;  ///< when the file is of one gender and says so
  Points3f v_template;           ///< 3 x V
  Eigen::MatrixXf shapedirs;     ///< (3V) x K; row 3v + c
  int expression_count = 0;      ///< of the K, after the shape
  int dmpl_count = 0;            ///< of the K, the last
  Faces faces;                   ///< 3 x F
  std::vector<int> parent;       ///< J; the root's is -1, every other's is smaller than the joint itself
  std::vector<std::string> joint_names;  ///< J
  Eigen::MatrixXi skin_joint;            ///< S x V joint indices
  Eigen::MatrixXf skin_weight;  ///< S x V, descending, each column sums to 1; 0 beyond the last weight
  /// Pose correctives in sparse blocks: vertex v moves by the sum over its blocks of D * feature(joint),
  /// rest frame, before skinning. Blocks of vertex v: [corrective_begin[v], corrective_begin[v + 1]).
  PoseFeature pose_feature = PoseFeature::rotation;
  std::vector<int> corrective_begin;                   ///< V + 1
  std::vector<int> corrective_joint;                   ///< B, never the root
  std::vector<Eigen::Matrix<float, 3, 9>> corrective;  ///< B
  /// Joint regressor as triplets, weights of one joint sum to 1.
  struct RegressorEntry {
    int joint;
    int vertex;
    float weight;
  };
  std::vector<RegressorEntry> regressor;
  std::vector<std::uint8_t> segment;  ///< V, 0..23, contract order
  std::vector<int> mirror;  ///< V, left-right partner of each vertex; empty when the mesh is not symmetric
  std::array<ShapePrior, 3> priors;  ///< by Gender
  std::array<HandPoses, 2> hands;    ///< left, right; empty without fingers

  // Derived by finish_model().
  Points3d joint_template;          ///< 3 x J, joints of the mean shape
  Eigen::MatrixXd joint_shapedirs;  ///< (3J) x K; row 3j + c
  Eigen::VectorXf vertex_area;      ///< V, m^2, a third of the incident template triangles

  int vertex_count() const { return static_cast<int>(v_template.cols()); }
  int face_count() const { return static_cast<int>(faces.cols()); }
  int joint_count() const { return static_cast<int>(parent.size()); }
  /// All K linear coefficients.
  int beta_count() const { return static_cast<int>(shapedirs.cols()); }
  /// Those of them that are shape.
  int shape_count() const { return beta_count() - expression_count - dmpl_count; }
  /// The model's joint that plays a joint of SMPL's 24: itself, but for the hands (22, 23) of models with
  /// fingers, where it is the middle finger's root.
  int joint_for_smpl(int smpl_joint) const;
  const ShapePrior& prior(Gender gender) const { return priors[static_cast<int>(gender)]; }
};

/// Names of the 24 segments in contract order, and of the SMPL joints whose weights they gather.
extern const std::array<std::string_view, 24> kSegmentNames;
extern const std::array<std::string_view, 24> kSmplJointNames;

/// Reads the default body's array file (models/README.md) and validates every index, shape and value.
/// @throws Error(bad_model).
BodyModel read_body_model(std::span<const std::byte> bytes, const std::string& file_name);

/// Fills the derived members after the primary ones have been set or changed.
void finish_model(BodyModel& model);

}  // namespace vitruvian
