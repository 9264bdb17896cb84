#pragma once

#include <vector>

#include "body/model.h"

namespace vitruvian {

/// Pose, shape and place of a body: rotations relative to the parent joint (the root's relative to the body
/// frame).
struct BodyState {
  std::vector<Mat3d> rotation;  ///< J
  Eigen::VectorXd betas;        ///< K
  Vec3d translation = Vec3d::Zero();

  /// Rest pose, mean shape, at the origin.
  static BodyState rest(const BodyModel& model);
  /// @param pose  3 x J axis-angle, root first.
  static BodyState from_axis_angle(const Points3d& pose, const Eigen::VectorXd& betas,
                                   const Vec3d& translation);
  Points3d axis_angle() const;
};

/// Joints of a posed body.
struct Skeleton {
  Points3d rest_joints;       ///< 3 x J, of the shaped body before posing
  std::vector<Mat3d> global;  ///< J, body_from_joint rotations
  Points3d joints;            ///< 3 x J, posed, translation included
};

/// Joint locations by the kinematic chain: Q = FK(R, J(beta)) of the paper's section 2.2.
Skeleton pose_skeleton(const BodyModel& model, const BodyState& state);

template <typename Scalar>
using VertexMatrix = Eigen::Matrix<Scalar, 3, Eigen::Dynamic>;

/// Shaped vertices before posing, T + B_S(beta); correctives not included. `rest` is resized to 3 x V.
template <typename Scalar>
void shape_vertices(const BodyModel& model, const Eigen::VectorXd& betas, VertexMatrix<Scalar>& rest);

/// Adds the pose correctives B_P(theta) to shaped vertices.
template <typename Scalar>
void add_correctives(const BodyModel& model, const BodyState& state, VertexMatrix<Scalar>& rest);

/// What the pose correctives of a joint with this rotation are multiplied by.
Eigen::Matrix<double, 9, 1> pose_feature(PoseFeature kind, const Mat3d& rotation);
/// Its derivative by a small turn w of the joint, rotation <- exp(w) rotation.
Eigen::Matrix<double, 9, 3> pose_feature_by_turn(PoseFeature kind, const Mat3d& rotation);

/// Linear blend skinning of rest vertices (shape and correctives included). `posed` is resized to 3 x V.
template <typename Scalar>
void skin_vertices(const BodyModel& model, const Skeleton& skeleton, const VertexMatrix<Scalar>& rest,
                   VertexMatrix<Scalar>& posed);

/// The whole forward model M(beta, theta) + translation; 3 x V in the body frame.
/// @param offsets  3 x V, metres, rest frame: added to the rest vertices before skinning; joints do not
/// follow them. Without columns: none.
template <typename Scalar>
VertexMatrix<Scalar> posed_vertices(const BodyModel& model, const BodyState& state,
                                    const Points3f& offsets = Points3f());

/// Rest-frame offsets that move each posed vertex by `displacement` (3 x V, body frame, metres): the inverse
/// of its blended skinning matrix. Where blending has flattened that matrix (a joint twisted by nearly half a
/// turn), the directions it lost stay without offset.
Points3f offsets_from_displacements(const BodyModel& model, const Skeleton& skeleton,
                                    const Points3d& displacement);

}  // namespace vitruvian
