#include "fit/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vitruvian {
namespace {

constexpr float kLeastNormalAgreement = 0.3f;
constexpr double kLandmarkScale = 0.03;
constexpr double kDamping = 1e-3;
constexpr double kLargestRotation = 0.4;
constexpr int kLeastModelTree = 3500;

float robust_weight(float squared_distance, float normal_agreement, float sigma) {
  if (normal_agreement < kLeastNormalAgreement) return 0;
  const float g = sigma * sigma / (squared_distance + sigma * sigma);
  return g * g;
}

/// Samples of the model matched to the scan.
[[gnu::noinline]] void match_model(const FitModel& model, const PosedModel& posed, const ScanTarget& scan,
                                   const FitStage& stage, float sigma, std::vector<Correspondence>& matches,
                                   const Execution& execution) {
  matches.resize(std::min<std::size_t>(stage.samples, model.order.size()));
  execution.parallel_for(
      static_cast<std::ptrdiff_t>(matches.size()), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const int v = model.order[i];
          const Vec3f x = posed.vertices.col(v), n = posed.normals.col(v);
          const int y = scan.nearest(v, x, n, stage.normals_in_search).index;
          if (y < 0) {
            matches[i] = {v, 0, 0, n, Vec3f::Zero()};
            continue;
          }
          const Vec3f error = x - scan.points.col(y);
          const Vec3f normal = scan.normals.col(y);
          const float weight = scan.unseen(y, error.squaredNorm())
                                   ? 0
                                   : robust_weight(error.squaredNorm(), normal.dot(n), sigma);
          matches[i] = {v, weight, static_cast<float>(stage.isotropy), normal, error};
        }
      });
}

/// Samples of the scan matched to the model.
[[gnu::noinline]] void match_scan(const PosedModel& posed, const ScanTarget& scan,
                                  const std::vector<KdTree>& model_trees, const FitStage& stage, float sigma,
                                  std::vector<Correspondence>& matches, const Execution& execution) {
  matches.resize(std::min<std::size_t>(stage.samples, scan.points.cols()));
  execution.parallel_for(
      static_cast<std::ptrdiff_t>(matches.size()), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Vec3f y = scan.points.col(i), normal = scan.normals.col(i);
          const KdTree& tree = model_trees[static_cast<std::size_t>(scan.regions.of_point(i))];
          if (tree.empty()) {
            matches[i] = {0, 0, 0, normal, Vec3f::Zero()};
            continue;
          }
          const int v = tree.nearest(y, normal).index;
          const Vec3f error = posed.vertices.col(v) - y;
          const float weight = robust_weight(error.squaredNorm(), normal.dot(posed.normals.col(v)), sigma);
          matches[i] = {v, weight, static_cast<float>(stage.isotropy), normal, error};
        }
      });
}

/// Trees of the model's vertices, one a label.
std::vector<KdTree> model_trees(const FitModel& model, const PosedModel& posed, const RegionLabels& regions,
                                const FitStage& stage) {
  const auto tree_of = [&](std::span<const int> subset) {
    return stage.normals_in_search ? KdTree(posed.vertices, posed.normals, ScanTarget::kNormalWeight, subset)
                                   : KdTree(posed.vertices, subset);
  };
  const std::size_t size =
      std::min<std::size_t>(model.order.size(), std::max(stage.samples, kLeastModelTree));
  std::vector<KdTree> trees;
  if (regions.count == 1) {
    trees.push_back(tree_of({model.order.data(), size}));
    return trees;
  }
  for (int label = 0; label < regions.count; ++label) {
    // A painted region is small: all of its vertices.
    std::vector<int> members;
    for (std::size_t i = 0; i < (label == 0 ? size : model.order.size()); ++i) {
      if (regions.of_vertex(model.order[i]) == label) members.push_back(model.order[i]);
    }
    trees.push_back(members.empty() ? KdTree() : tree_of(members));
  }
  return trees;
}

double mean(std::span<const float> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return sum / static_cast<double>(std::max<std::size_t>(1, values.size()));
}

double percentile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

FitSchedule FitSchedule::full() {
  return {{{24, 700, 0.10, 0.04, 0.3, 0.03, 1.0, 0.05, 0.03, true},
           {8, 1500, 0.04, 0.01, 0.3, 0.01, 0.3, 0.02, 0.01, true},
           {4, 4000, 0.01, 0.005, 0.0, 0.003, 0.1, 0.005, 0.0, false}}};
}

FitSchedule FitSchedule::coarse() {
  FitSchedule schedule = full();
  schedule.stages.pop_back();
  return schedule;
}

FitSchedule FitSchedule::after_limb_search() {
  return {{{14, 700, 0.08, 0.04, 0.3, 0.03, 1.0, 0.05, 0.0, true},
           {6, 1500, 0.04, 0.01, 0.3, 0.01, 0.3, 0.02, 0.0, true}}};
}

FitSchedule FitSchedule::polish() { return {{full().stages.back()}}; }

void fit_surface(const FitModel& model, const ScanTarget& scan, const FitSchedule& schedule,
                 std::span<const LandmarkTarget> landmarks, BodyState& state, const Execution& execution,
                 const FitObserver& each) {
  NormalEquations equations(model);
  PosedModel posed;
  std::vector<Correspondence> of_model, of_scan;
  int number = -1;
  for (const FitStage& stage : schedule.stages) {
    ++number;
    of_scan.clear();
    for (int i = 0; i < stage.iterations; ++i) {
      execution.check();
      posed.update(model, state);
      const double sigma =
          stage.sigma_begin * std::pow(stage.sigma_end / stage.sigma_begin,
                                       static_cast<double>(i) / std::max(1, stage.iterations));
      match_model(model, posed, scan, stage, static_cast<float>(sigma), of_model, execution);
      if (stage.from_scan) {
        match_scan(posed, scan, model_trees(model, posed, scan.regions, stage), stage,
                   static_cast<float>(sigma), of_scan, execution);
      }
      if (each) {
        each({number, sigma, state, posed.skeleton, &posed.vertices, of_model, of_scan, landmarks,
              kLandmarkScale, stage.landmarks, stage.gaussian, stage.limits, stage.shape});
      }
      const BodyJacobian<float> jacobian(model.body, model.groups, state, posed.skeleton, posed.rest);
      equations.clear();
      const double unit = 1 / (sigma * sigma);
      equations.add(jacobian, of_model, unit / static_cast<double>(of_model.size()), execution);
      if (!of_scan.empty())
        equations.add(jacobian, of_scan, unit / static_cast<double>(of_scan.size()), execution);
      if (stage.landmarks > 0 && !landmarks.empty()) {
        for (const LandmarkTarget& l : landmarks) {
          const double squared = (landmark_position(posed.skeleton, l) - l.target).squaredNorm();
          const double robust = 1 / (1 + squared / (4 * kLandmarkScale * kLandmarkScale));
          equations.add(jacobian, posed, l,
                        stage.landmarks * robust /
                            (static_cast<double>(landmarks.size()) * kLandmarkScale * kLandmarkScale));
        }
      }
      equations.add_pose_prior(state, posed, stage.gaussian, stage.limits);
      equations.add_shape_prior(state, stage.shape);
      equations.step(posed, kDamping, kLargestRotation, state);
    }
  }
}

FitScore score_fit(const FitModel& model, const ScanTarget& scan, const BodyState& state, int samples) {
  PosedModel posed;
  posed.update(model, state);
  FitScore score;
  int opposed = 0;
  std::vector<float> of_model, of_scan, with_normals;
  const int model_count = std::min<int>(samples, static_cast<int>(model.order.size()));
  for (int i = 0; i < model_count; ++i) {
    const int v = model.order[i];
    const Vec3f x = posed.vertices.col(v), n = posed.normals.col(v);
    const Neighbour facing = scan.nearest(v, x, n, true);
    if (facing.index < 0 || scan.unseen(facing.index, (x - scan.points.col(facing.index)).squaredNorm()))
      continue;
    const Neighbour y = scan.nearest(v, x, n, false);
    of_model.push_back(std::sqrt(y.squared_distance));
    opposed += scan.normals.col(y.index).dot(n) < 0;
    with_normals.push_back(std::sqrt(facing.squared_distance));
  }
  score.model_to_scan = mean(with_normals);
  score.typical = percentile(with_normals, 0.5);
  with_normals.clear();
  FitStage whole{};
  whole.samples = model.body.vertex_count();
  const std::vector<KdTree> trees = model_trees(model, posed, scan.regions, whole);
  whole.normals_in_search = true;
  const std::vector<KdTree> trees_with_normals = model_trees(model, posed, scan.regions, whole);
  const int scan_count = std::min<int>(samples, static_cast<int>(scan.points.cols()));
  for (int i = 0; i < scan_count; ++i) {
    const std::size_t label = static_cast<std::size_t>(scan.regions.of_point(i));
    if (trees[label].empty()) continue;
    const Vec3f y = scan.points.col(i), n = scan.normals.col(i);
    const Neighbour v = trees[label].nearest(y);
    of_scan.push_back(std::sqrt(v.squared_distance));
    opposed += n.dot(posed.normals.col(v.index)) < 0;
    with_normals.push_back(std::sqrt(trees_with_normals[label].nearest(y, n).squared_distance));
  }
  const std::size_t pairs = of_model.size() + of_scan.size();
  score.scan_to_model = mean(with_normals);
  score.typical += percentile(with_normals, 0.5);
  score.model_to_scan_p95 = percentile(of_model, 0.95);
  score.scan_to_model_p95 = percentile(of_scan, 0.95);
  score.model_to_scan_p99 = percentile(of_model, 0.99);
  score.scan_to_model_p99 = percentile(of_scan, 0.99);
  score.opposed_normals = static_cast<double>(opposed) / static_cast<double>(std::max<std::size_t>(1, pairs));
  return score;
}

}  // namespace vitruvian
