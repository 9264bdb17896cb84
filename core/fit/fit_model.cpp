#include "fit/fit_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

constexpr std::uint32_t kOrderSeed = 7;
/// Where every joint corrects every vertex, as in SMPL's files, the derivatives know only the strongest
/// blocks of each vertex.
constexpr int kDenseCorrectives = 12, kMostCorrectives = 4;
constexpr Index kFewWeights = 4;
constexpr float kLeastWeight = 1e-3f;

int most_correctives(const BodyModel& body) {
  return static_cast<int>(body.corrective.size()) > kDenseCorrectives * body.vertex_count() ? kMostCorrectives
                                                                                            : 0;
}

/// Marginal of the prior over its first components: the covariance is cut, not the precision.
ShapePrior cut(const ShapePrior& prior, int betas) {
  if (betas == prior.mean.size()) return prior;
  const Eigen::MatrixXd covariance = prior.precision.inverse();
  return {prior.mean.head(betas), covariance.topLeftCorner(betas, betas).inverse()};
}

}  // namespace

FitModel::FitModel(const BodyModel& body_model, const PosePrior& pose_prior, Gender gender, int beta_limit)
    : body(body_model),
      prior(pose_prior),
      betas(beta_limit > 0 && beta_limit < body_model.shape_count() ? beta_limit : body_model.beta_count()),
      groups(body_model, most_correctives(body_model),
             body_model.skin_joint.rows() > kFewWeights ? kLeastWeight : 0) {
  shape_prior = cut(body.prior(gender), betas);
  Random random(kOrderSeed);
  std::vector<std::pair<double, int>> keys(body.vertex_count());
  for (int v = 0; v < body.vertex_count(); ++v) {
    // Exponential keys: sampling without replacement, proportional to area (Efraimidis and Spirakis 2006).
    keys[v] = {-std::log(1 - random.uniform()) / std::max(1e-9f, body.vertex_area[v]), v};
  }
  std::sort(keys.begin(), keys.end());
  order.reserve(keys.size());
  for (const auto& [key, vertex] : keys) order.push_back(vertex);
}

void PosedModel::update(const FitModel& model, const BodyState& state) {
  skeleton = pose_skeleton(model.body, state);
  shape_vertices(model.body, state.betas, rest);
  add_correctives(model.body, state, rest);
  skin_vertices(model.body, skeleton, rest, vertices);
  normals = vertex_normals(vertices, model.body.faces);
}

}  // namespace vitruvian
