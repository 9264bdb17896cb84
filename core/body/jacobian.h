#pragma once

#include <cstdint>
#include <vector>

#include "body/forward.h"

namespace vitruvian {

/// Which joints move which vertex: the ancestors of every joint that weighs on it or corrects it. Vertices
/// with the same set form a group, so that rows of a Jacobian can be multiplied as one block.
///
/// Models whose every vertex is corrected by every joint (SMPL's are) would have one group of all joints;
/// most of these blocks move their vertex by less than a millimetre. A fit does without the weakest of them
/// in its derivatives, never in the body itself.
struct AncestorGroups {
  std::vector<int> group_of_vertex;      ///< V
  std::vector<std::vector<int>> joints;  ///< ascending joint indices, a group
  std::vector<std::uint64_t> ancestors;  ///< J bit masks, the joint itself included
  /// Correctives that count: vertex v's are [block_begin[v], block_begin[v + 1]) of the next two.
  std::vector<int> block_begin;
  std::vector<int> block;       ///< index into BodyModel::corrective
  std::vector<int> block_slot;  ///< place of its joint among the group's
  /// @param most_correctives  the strongest blocks of a vertex that count; 0 = all (exact derivatives).
  /// @param least_weight      skinning weights that count for the groups.
  explicit AncestorGroups(const BodyModel& model, int most_correctives = 0, float least_weight = 0);
};

/// Derivatives of posed vertices and joints with respect to the state.
///
/// Order of the full unknowns: translation (3), pose (3 J), betas (K). A pose unknown is a small rotation of
/// the joint in the BODY frame: increments w turn joint j by R_j <- global_parent^T exp(w) global_parent R_j,
/// so that everything below j turns by exp(w) about the joint's posed location. axis_angle_chain() turns this
/// into derivatives by axis-angle.
template <typename Scalar>
class BodyJacobian {
 public:
  using Compact = Eigen::Matrix<Scalar, 3, Eigen::Dynamic>;

  /// All references must outlive the object. `rest` holds the rest vertices with correctives.
  BodyJacobian(const BodyModel& model, const AncestorGroups& groups, const BodyState& state,
               const Skeleton& skeleton, const VertexMatrix<Scalar>& rest);

  /// Number of columns of a group's compact Jacobian: 3 + 3 x joints + K.
  int compact_size(int group) const {
    return 3 + 3 * static_cast<int>(groups_.joints[group].size()) + betas_;
  }

  /// d vertex / d (translation, the group's joints, betas), written to the first compact_size columns of
  /// `out`.
  void vertex(int vertex, Eigen::Ref<Compact> out) const;

  /// Full 3 x (3 + 3J + K) derivative of a vertex (tests, small problems).
  Compact full_vertex(int vertex) const;
  /// Full 3 x (3 + 3J + K) derivative of a posed joint.
  Eigen::MatrixXd full_joint(int joint) const;

 private:
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

  const BodyModel& model_;
  const AncestorGroups& groups_;
  const VertexMatrix<Scalar>& rest_;
  int betas_;
  std::vector<Matrix3> rotation_;                                          // J, global
  std::vector<Vector3> offset_;                                            // J, joint - global * rest_joint
  Eigen::Matrix<Scalar, 3, Eigen::Dynamic> joints_;                        // posed
  std::vector<Eigen::MatrixXd> joint_by_betas_;                            // J of 3 x K
  std::vector<Eigen::Matrix<Scalar, 3, Eigen::Dynamic>> offset_by_betas_;  // J of 3 x K
  std::vector<Eigen::Matrix<Scalar, 9, 3>> rotation_by_increment_;         // J: d feature(R_j) / d w_j
  Points3d joints_double_;
};

/// 3 x 3 matrix M of joint j with w = M d(theta_j): body-frame increment from a change of its axis-angle.
Mat3d axis_angle_chain(const BodyModel& model, const Skeleton& skeleton, const Vec3d& axis_angle, int joint);

/// Applies an update (translation, pose increments, betas) to a state. Sizes as in the full order.
void apply_update(const BodyModel& model, const Skeleton& skeleton, const Eigen::VectorXd& update,
                  BodyState& state);

}  // namespace vitruvian
