#pragma once

#include <vector>

#include "body/jacobian.h"
#include "pose/pose_prior.h"

namespace vitruvian {

/// What every fit of one body model needs, prepared once. The model and the prior must outlive it.
struct FitModel {
  const BodyModel& body;
  const PosePrior& prior;
  ShapePrior shape_prior;  ///< cut to `betas` components
  int betas;               ///< shape components that are fitted
  AncestorGroups groups;
  /// All vertices in a random order in which every prefix is spread by area over the body (head and hands
  /// hold most vertices but little area).
  std::vector<int> order;

  /// @param betas  shape components to fit (expression and soft tissue are then left out); 0 or as many as
  /// the model has: all, expression and soft tissue included.
  FitModel(const BodyModel& body, const PosePrior& prior, Gender gender, int betas);

  int unknowns() const { return 3 + 3 * body.joint_count() + betas; }
};

/// A body as it is now, with all that depends on its state.
struct PosedModel {
  Skeleton skeleton;
  VertexMatrix<float> rest;  ///< shaped, with correctives
  Points3f vertices;
  Points3f normals;

  void update(const FitModel& model, const BodyState& state);
};

}  // namespace vitruvian
