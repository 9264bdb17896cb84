#pragma once

#include <span>
#include <vector>

#include "base/execution.h"
#include "fit/fit_model.h"

namespace vitruvian {

/// A model vertex that should lie on the scan's tangent plane at a point y: residual n . (x - y), and,
/// weighted by `isotropy`, the whole vector x - y.
struct Correspondence {
  int vertex;
  float weight;
  float isotropy;
  Vec3f normal;  ///< of the scan at y, unit
  Vec3f error;   ///< x - y
};

/// A landmark that sits at a constant offset in a bone's frame: joint + global(frame_joint) * offset should
/// be at target.
struct LandmarkTarget {
  static constexpr int kJointItself = -1;
  int landmark;  ///< BlazePose number, 0..32, or kJointItself
  int joint;
  int frame_joint;
  Vec3d offset;
  Vec3d target;   ///< body frame
  double weight;  ///< 0 = unused
};

/// Gauss-Newton system over the full unknowns (translation, pose increments, betas; see BodyJacobian).
class NormalEquations {
 public:
  explicit NormalEquations(const FitModel& model);

  void clear();

  /// Adds scale * sum weight (n.e)^2 + isotropy |e|^2. Float rows, multiplied by groups of vertices that
  /// depend on the same joints.
  void add(const BodyJacobian<float>& jacobian, std::span<const Correspondence> correspondences, double scale,
           const Execution& execution);

  /// Adds scale * weight |x - target|^2 of one landmark (weight taken as given, robust factor included by the
  /// caller).
  void add(const BodyJacobian<float>& jacobian, const PosedModel& posed, const LandmarkTarget& landmark,
           double scale);

  /// Adds gaussian/69 * Mahalanobis distance to the pose prior + limits/69 * sum (excess / 0.1 rad)^2.
  void add_pose_prior(const BodyState& state, const PosedModel& posed, double gaussian, double limits);

  /// Adds scale/K * Mahalanobis distance of the betas to the shape prior.
  void add_shape_prior(const BodyState& state, double scale);

  /// Adds scale * |increment|^2 that holds the pose of one joint where it is.
  void hold_joint(int joint, double scale);

  /// Levenberg-Marquardt step: solves (H + damping diag(H)) x = -g; rotations limited to `largest_rotation`
  /// rad a joint and betas to +-5.
  void step(const PosedModel& posed, double damping, double largest_rotation, BodyState& state) const;

  const Eigen::MatrixXd& hessian() const { return hessian_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
  const FitModel& model_;
  Eigen::MatrixXd hessian_;  // lower triangle
  Eigen::VectorXd gradient_;
};

/// Position of a landmark on a posed body.
Vec3d landmark_position(const Skeleton& skeleton, const LandmarkTarget& landmark);

}  // namespace vitruvian
