#include "fit/fit_trace.h"

#include <algorithm>
#include <cmath>

#include "fit/landmark_fit.h"

namespace vitruvian {
namespace {

constexpr double kLimitScale = 0.1;  // rad, as in NormalEquations

/// sum weight ((n.e)^2 + isotropy |e|^2), a sample, in units of the scale.
double surface_energy(std::span<const Correspondence> matches, double scale) {
  if (matches.empty()) return 0;
  double sum = 0;
  for (const Correspondence& c : matches) {
    const double along = c.normal.dot(c.error);
    sum += c.weight * (along * along + c.isotropy * c.error.squaredNorm());
  }
  return sum / (static_cast<double>(matches.size()) * scale * scale);
}

double median_distance(std::span<const Correspondence> matches) {
  std::vector<double> distances;
  for (const Correspondence& c : matches) {
    if (c.weight > 0) distances.push_back(std::abs(c.normal.dot(c.error)));
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

double landmark_energy(const FitIteration& it) {
  double sum = 0;
  for (const LandmarkTarget& l : it.landmarks) {
    if (!(l.weight > 0)) continue;
    const double squared = (landmark_position(it.skeleton, l) - l.target).squaredNorm() /
                           (it.landmark_scale * it.landmark_scale);
    sum += l.weight * squared / (1 + squared / 4);
  }
  return it.landmarks.empty() ? 0 : it.landmark_weight * sum / static_cast<double>(it.landmarks.size());
}

using Pairs = Eigen::Matrix<float, 6, Eigen::Dynamic>;

/// Adds up to `most` pairs.
void pick_pairs(std::span<const Correspondence> matches, const Points3f& vertices, int most, Pairs& pairs) {
  const std::size_t step = matches.size() / static_cast<std::size_t>(most) + 1;
  std::vector<std::size_t> picked;
  for (std::size_t i = 0; i < matches.size(); i += step) {
    if (matches[i].weight > 0) picked.push_back(i);
  }
  const Index before = pairs.cols();
  pairs.conservativeResize(6, before + static_cast<Index>(picked.size()));
  for (std::size_t k = 0; k < picked.size(); ++k) {
    const Correspondence& c = matches[picked[k]];
    const Vec3f x = vertices.col(c.vertex);
    pairs.col(before + static_cast<Index>(k)) << x, x - c.error;
  }
}

}  // namespace

FitEnergy energy_of(const FitModel& model, const FitIteration& it) {
  FitEnergy energy;
  energy.model_to_scan = surface_energy(it.of_model, it.scale);
  energy.scan_to_model = surface_energy(it.of_scan, it.scale);
  energy.landmarks = landmark_energy(it);
  const PosePrior& prior = model.prior;
  const Points3d pose = it.state.axis_angle();
  const Index numbers = pose.size() - 3;
  if (numbers == prior.mean.size()) {
    const Eigen::Map<const Eigen::VectorXd> theta(pose.data() + 3, numbers);
    const Eigen::VectorXd off = theta - prior.mean;
    energy.pose_prior = it.gaussian / PosePrior::kSize * off.dot(prior.precision * off);
    const Eigen::ArrayXd excess = (theta - prior.limit_high).cwiseMax(prior.limit_low - theta).cwiseMax(0.0);
    energy.joint_limits = it.limits / PosePrior::kSize * (excess / kLimitScale).square().sum();
  }
  const Eigen::VectorXd shape = it.state.betas - model.shape_prior.mean;
  energy.shape_prior = it.shape / std::max(1, model.betas) * shape.dot(model.shape_prior.precision * shape);
  return energy;
}

FitObserver FitTrace::observer() {
  return [this](const FitIteration& it) {
    TraceStep step;
    step.stage = it.stage;
    step.scale = it.scale;
    step.energy = energy_of(model_, it);
    step.model_to_scan_m = median_distance(it.of_model);
    step.scan_to_model_m = median_distance(it.of_scan);
    step.landmark_m = landmark_error(it.skeleton, it.landmarks);
    step.joints = it.skeleton.joints.cast<float>();
    step.state = it.state;
    if (it.vertices) {
      pick_pairs(it.of_model, *it.vertices, most_pairs_ / 2, step.pairs);
      step.pairs_of_model = static_cast<int>(step.pairs.cols());
      pick_pairs(it.of_scan, *it.vertices, most_pairs_ / 2, step.pairs);
    }
    add(std::move(step));
  };
}

void FitTrace::finish(const BodyState& state) {
  TraceStep step;
  if (!steps_.empty()) {
    // Distances and energies are those that the last step started from.
    step = steps_.back();
    step.pairs.resize(6, 0);
    step.pairs_of_model = 0;
  }
  step.state = state;
  step.joints = pose_skeleton(model_.body, state).joints.cast<float>();
  add(std::move(step));
}

void FitTrace::add(TraceStep step) {
  if (static_cast<int>(steps_.size()) >= most_steps_) steps_.pop_back();
  steps_.push_back(std::move(step));
}

}  // namespace vitruvian
