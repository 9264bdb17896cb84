#pragma once

#include "base/execution.h"
#include "body/forward.h"

namespace vitruvian {

/// A body as a function of one vector of numbers, and the way back: from derivatives by the vertices to
/// derivatives by the numbers (reverse mode, one pass over the vertices whatever the number of unknowns).
///
/// Order of the numbers: translation (3), axis-angle of each joint (3 J, root first), betas (K). Unlike the
/// increments of BodyJacobian these are the parameters themselves, as first-order optimisers want them.
class ParametricBody {
 public:
  /// @param betas  shape components used, at most the model's. The model must outlive the object.
  ParametricBody(const BodyModel& model, int betas);

  int size() const { return 3 + 3 * model_.joint_count() + betas_; }
  int betas() const { return betas_; }
  int joint_count() const { return model_.joint_count(); }

  Eigen::VectorXd numbers_of(const BodyState& state) const;
  BodyState state_of(const Eigen::VectorXd& numbers) const;

  /// Poses the body and keeps what pull_back() needs. @return 3 x V, body frame, valid until the next call.
  const Points3f& pose(const Eigen::VectorXd& numbers);

  /// Chain rule at the numbers last posed: d f / d numbers (size()) from d f / d vertices (3 x V).
  void pull_back(const Points3f& by_vertex, Eigen::VectorXd& by_numbers, const Execution& execution) const;

 private:
  const BodyModel& model_;
  int betas_;
  Points3d axis_angle_;
  BodyState state_;
  Skeleton skeleton_;
  VertexMatrix<float> rest_;
  Points3f vertices_;
};

}  // namespace vitruvian
