#pragma once

#include <algorithm>

#include "base/random.h"
#include "body/forward.h"
#include "body/model.h"

namespace vitruvian::testing {

/// A small model of any size with random geometry, weights and correctives: nothing in the maths may depend
/// on the default body's numbers.
inline BodyModel random_model(std::uint32_t seed, int joints, int vertices, int betas, int weights_per_vertex,
                              PoseFeature pose_feature = PoseFeature::rotation) {
  Random random(seed);
  BodyModel model;
  model.name = "random";
  model.family = "vitruvian";
  model.pose_feature = pose_feature;
  const auto fill = [&](auto& matrix, double scale) {
    for (Index i = 0; i < matrix.size(); ++i) {
      matrix.data()[i] =
          static_cast<typename std::decay_t<decltype(matrix)>::Scalar>(scale * random.normal());
    }
  };
  model.v_template.resize(3, vertices);
  fill(model.v_template, 0.5);
  model.shapedirs.resize(3 * vertices, betas);
  fill(model.shapedirs, 0.02);
  model.faces.resize(3, vertices);
  for (int f = 0; f < vertices; ++f) model.faces.col(f) << f, (f + 1) % vertices, (f + 2) % vertices;
  model.parent.assign(joints, -1);
  for (int j = 1; j < joints; ++j)
    model.parent[j] = static_cast<int>(random.below(static_cast<std::uint32_t>(j)));
  for (int j = 0; j < joints; ++j) model.joint_names.push_back("joint" + std::to_string(j));
  model.skin_joint.resize(weights_per_vertex, vertices);
  model.skin_weight.resize(weights_per_vertex, vertices);
  model.corrective_begin.assign(1, 0);
  for (int v = 0; v < vertices; ++v) {
    std::vector<float> weights;
    float sum = 0;
    for (int k = 0; k < weights_per_vertex; ++k) {
      weights.push_back(static_cast<float>(k > 0 && random.uniform() < 0.3 ? 0 : random.uniform(0.05, 1)));
      sum += weights.back();
    }
    std::sort(weights.rbegin(), weights.rend());
    for (int k = 0; k < weights_per_vertex; ++k) {
      model.skin_weight(k, v) = weights[k] / sum;
      model.skin_joint(k, v) = static_cast<int>(random.below(static_cast<std::uint32_t>(joints)));
    }
    for (int j = 1; j < joints; ++j) {
      if (random.uniform() < 0.3) {
        model.corrective_joint.push_back(j);
        model.corrective.emplace_back();
        fill(model.corrective.back(), 0.02);
      }
    }
    model.corrective_begin.push_back(static_cast<int>(model.corrective.size()));
    model.segment.push_back(static_cast<std::uint8_t>(random.below(24)));
  }
  for (int j = 0; j < joints; ++j) {
    const float share = static_cast<float>(random.uniform(0.2, 0.8));
    model.regressor.push_back(
        {j, static_cast<int>(random.below(static_cast<std::uint32_t>(vertices))), share});
    model.regressor.push_back(
        {j, static_cast<int>(random.below(static_cast<std::uint32_t>(vertices))), 1 - share});
  }
  for (ShapePrior& prior : model.priors) {
    prior.mean = Eigen::VectorXd::Zero(betas);
    prior.precision = Eigen::MatrixXd::Identity(betas, betas);
  }
  finish_model(model);
  return model;
}

inline BodyState random_state(const BodyModel& model, std::uint32_t seed, double pose_scale = 0.6) {
  Random random(seed);
  Points3d pose(3, model.joint_count());
  for (Index i = 0; i < pose.size(); ++i) pose.data()[i] = pose_scale * random.normal();
  Eigen::VectorXd betas(model.beta_count());
  for (Index k = 0; k < betas.size(); ++k) betas[k] = random.normal();
  return BodyState::from_axis_angle(pose, betas, Vec3d(random.normal(), random.normal(), random.normal()));
}

}  // namespace vitruvian::testing
