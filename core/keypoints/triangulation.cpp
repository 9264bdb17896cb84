#include "keypoints/triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "base/error.h"
#include "keypoints/left_right.h"

namespace vitruvian {
namespace {

using Pair = std::pair<int, int>;

/// Pairs whose agreement decides, by group: knees, ankles, heels, feet; elbows, wrists, pinkies, indices;
/// shoulders, hips, ears.
const std::vector<Pair> kDecidingPairs[kLimbGroupCount] = {{{25, 26}, {27, 28}, {29, 30}, {31, 32}},
                                                           {{13, 14}, {15, 16}, {17, 18}, {19, 20}},
                                                           {{11, 12}, {23, 24}, {7, 8}}};
/// Pairs that follow: thumbs with the arms; eyes and corners of the mouth with the torso.
const std::vector<Pair> kFollowingPairs[kLimbGroupCount] = {
    {}, {{21, 22}}, {{1, 4}, {2, 5}, {3, 6}, {9, 10}}};

constexpr int kAllPatternsUpTo = 10;

/// Bit v: left and right are exchanged in view v.
using Pattern = std::uint32_t;
constexpr int kMostViews = 32;

/// One landmark seen in all views: coordinates along each camera's right and up axis, and weights.
struct Rays {
  std::vector<Eigen::Vector2d> along;
  std::vector<double> weight;
};

struct Solution {
  Vec3d position = Vec3d::Zero();
  double cost = 0;        ///< weighted mean of log(1 + (e / scale)^2)
  double agreement = 0;   ///< share of the weight that the kernel left, 0..1
  double residual = 0;    ///< metres
  double visibility = 0;  ///< weighted mean over the views that agree
};

class Solver {
 public:
  Solver(std::span<const Camera> cameras, std::span<const ViewLandmarks> views,
         const TriangulationSettings& settings)
      : settings_(settings) {
    for (const Camera& camera : cameras) {
      Eigen::Matrix<double, 2, 3> axes;
      axes << camera.right.cast<double>().transpose(), camera.up.cast<double>().transpose();
      axes_.push_back(axes);
      normal_.push_back(axes.transpose() * axes);
    }
    rays_.resize(kLandmarkCount);
    for (int l = 0; l < kLandmarkCount; ++l) {
      for (std::size_t v = 0; v < views.size(); ++v) {
        const ViewLandmark& seen = views[v].landmarks[l];
        const Camera& camera = cameras[v];
        const Eigen::Vector2d offset((seen.pixel.x() - 0.5 * camera.width) / camera.pixels_per_metre,
                                     (0.5 * camera.height - seen.pixel.y()) / camera.pixels_per_metre);
        const bool usable = offset.allFinite() && std::isfinite(seen.visibility) &&
                            seen.visibility >= settings.min_visibility;
        rays_[l].along.push_back(usable ? Eigen::Vector2d(offset + axes_[v] * camera.centre.cast<double>())
                                        : Eigen::Vector2d::Zero());
        rays_[l].weight.push_back(usable ? std::max<double>(seen.visibility, settings.least_weight) : 0.0);
      }
    }
  }

  int view_count() const { return static_cast<int>(axes_.size()); }

  /// Position of `landmark`, taking `other`'s observation in the views of `swapped`.
  Solution solve(int landmark, int other, Pattern swapped) const {
    const int n = view_count();
    std::array<double, kMostViews> weight{}, robust{}, squared{};
    std::array<const Eigen::Vector2d*, kMostViews> along{};
    double total = 0;
    for (int v = 0; v < n; ++v) {
      const Rays& rays = rays_[swapped >> v & 1 ? other : landmark];
      weight[v] = robust[v] = rays.weight[v];
      along[v] = &rays.along[v];
      total += weight[v];
    }
    Solution solution;
    if (total <= 0) return solution;
    double scale = settings_.start_scale;
    for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
      Mat3d matrix = 1e-6 * Mat3d::Identity();
      Vec3d right = Vec3d::Zero();
      for (int v = 0; v < n; ++v) {
        matrix += robust[v] * normal_[v];
        right += robust[v] * (axes_[v].transpose() * *along[v]);
      }
      solution.position = matrix.llt().solve(right);
      const double used = std::max(settings_.scale, scale);
      for (int v = 0; v < n; ++v) {
        squared[v] = (axes_[v] * solution.position - *along[v]).squaredNorm();
        robust[v] = weight[v] / (1 + squared[v] / (used * used));
      }
      scale *= 0.6;
    }
    double left = 0, error = 0, visible = 0;
    for (int v = 0; v < n; ++v) {
      solution.cost += weight[v] * std::log1p(squared[v] / (settings_.scale * settings_.scale)) / total;
      left += robust[v];
      error += robust[v] * squared[v];
      visible += robust[v] * std::min(1.0, weight[v]);
    }
    solution.agreement = left / total;
    solution.residual = left > 0 ? std::sqrt(error / left) : 0;
    solution.visibility = left > 0 ? visible / left : 0;
    return solution;
  }

  Pattern complement(Pattern swapped) const {
    return swapped ^ static_cast<Pattern>((std::uint64_t{1} << view_count()) - 1);
  }

  /// Pattern of a group that fits best, up to its complement; each view in which it differs from `usual`
  /// costs a little.
  Pattern best_fit(LimbGroup group, Pattern usual) const {
    const int n = view_count();
    if (n < 3) return usual;  // any two rays nearly meet: nothing tells a swap
    Pattern best = usual;
    double best_cost = cost(group, best);
    const auto consider = [&](Pattern pattern) {
      const int differences = std::popcount(pattern ^ usual);
      if (2 * differences > n) pattern = complement(pattern);
      const double whole = cost(group, pattern) + penalty(std::min(differences, n - differences));
      if (whole >= best_cost) return false;
      best_cost = whole;
      best = pattern;
      return true;
    };
    if (n <= kAllPatternsUpTo) {
      // The last view stays unswapped: a pattern and its complement fit alike.
      for (Pattern pattern = 0; pattern < Pattern{1} << (n - 1); ++pattern) consider(pattern);
      return best;
    }
    for (int first = 0; first < n; ++first) {
      Pattern arc = 0;
      for (int length = 0; length < n / 2; ++length) {
        arc |= Pattern{1} << (first + length) % n;
        consider(usual ^ arc);
      }
    }
    for (bool better = true; better;) {
      better = false;
      for (int v = 0; v < n; ++v) better = consider(best ^ Pattern{1} << v) || better;
    }
    return best;
  }

  /// Decides between a pattern and its complement, which fit alike. Only views that tell left from right
  /// clearly have a vote (in a side view of the legs both labels fit); `doubt` > 0 speaks against the
  /// pattern.
  Pattern labelled(LimbGroup group, Pattern pattern, Pattern usual, double doubt) const {
    const std::vector<double> clear = clarity(group, pattern);
    double for_it = 0, against = 0;
    for (int v = 0; v < view_count(); ++v) ((pattern ^ usual) >> v & 1 ? against : for_it) += clear[v];
    if (penalty(for_it) >= penalty(against) + doubt) return pattern;
    Pattern chosen = complement(pattern);
    double chosen_cost = cost(group, chosen) + penalty(std::popcount(chosen ^ usual));
    for (int v = 0; v < view_count(); ++v) {
      const Pattern changed = chosen ^ Pattern { 1 } << v;
      const double changed_cost = cost(group, changed) + penalty(std::popcount(changed ^ usual));
      if (clear[v] < kClear && changed_cost < chosen_cost) {
        chosen = changed;
        chosen_cost = changed_cost;
      }
    }
    return chosen;
  }

 private:
  /// Clarity below which a view does not tell left from right.
  static constexpr double kClear = 0.5;

  double penalty(double views) const { return settings_.swap_penalty * views / view_count(); }

  /// Misfit of a pattern for a group; the same for its complement.
  double cost(LimbGroup group, Pattern swapped) const {
    double sum = 0;
    const auto& pairs = kDecidingPairs[static_cast<int>(group)];
    for (const Pair& pair : pairs) {
      sum += solve(pair.first, pair.second, swapped).cost + solve(pair.second, pair.first, swapped).cost;
    }
    return sum / static_cast<double>(pairs.size());
  }

  /// For each view, how much worse the other assignment would fit the points found, 0..1.
  std::vector<double> clarity(LimbGroup group, Pattern swapped) const {
    const auto& pairs = kDecidingPairs[static_cast<int>(group)];
    std::vector<double> clear(axes_.size(), 0.0);
    for (const auto& [left, right] : pairs) {
      const Vec3d at_left = solve(left, right, swapped).position,
                  at_right = solve(right, left, swapped).position;
      for (std::size_t v = 0; v < clear.size(); ++v) {
        const bool swap = swapped >> v & 1;
        const int seen_left = swap ? right : left, seen_right = swap ? left : right;
        if (rays_[left].weight[v] <= 0 || rays_[right].weight[v] <= 0) continue;
        const auto misfit = [&](const Vec3d& position, int seen) {
          const double squared = (axes_[v] * position - rays_[seen].along[v]).squaredNorm();
          return std::log1p(squared / (settings_.scale * settings_.scale));
        };
        clear[v] += (misfit(at_left, seen_right) + misfit(at_right, seen_left) - misfit(at_left, seen_left) -
                     misfit(at_right, seen_right)) /
                    (2.0 * static_cast<double>(pairs.size()));
      }
    }
    for (double& c : clear) c = std::clamp(c, 0.0, 1.0);
    return clear;
  }

  TriangulationSettings settings_;
  std::vector<Eigen::Matrix<double, 2, 3>> axes_;
  std::vector<Mat3d> normal_;
  std::vector<Rays> rays_;
};

Landmark3d landmark_of(const Solution& solution) {
  return {solution.position.cast<float>(),
          static_cast<float>(std::clamp(solution.agreement * solution.visibility, 0.0, 1.0)),
          static_cast<float>(solution.residual)};
}

/// Positions of a group's landmarks with left and right exchanged in the views of `swapped`.
void place(const Solver& solver, LimbGroup group, Pattern swapped, std::vector<Landmark3d>& landmarks) {
  const int g = static_cast<int>(group);
  for (const auto* pairs : {&kDecidingPairs[g], &kFollowingPairs[g]}) {
    for (const auto& [left, right] : *pairs) {
      landmarks[left] = landmark_of(solver.solve(left, right, swapped));
      landmarks[right] = landmark_of(solver.solve(right, left, swapped));
    }
  }
}

/// How much a group's left and right look exchanged as a whole, from -1 (surely not) to 1; 0 when nothing can
/// be said. Limbs: knees (elbows) are nearer to the hip (shoulder) of their own side. Torso: chest and nose
/// point the same way.
double wrong_side(LimbGroup group, const std::vector<Landmark3d>& landmarks) {
  const auto at = [&](int l) -> const Vec3f& { return landmarks[l].position; };
  const auto known = [&](std::initializer_list<int> all) {
    return std::all_of(all.begin(), all.end(), [&](int l) { return landmarks[l].confidence > 0; });
  };
  if (group == LimbGroup::torso) {
    constexpr double kFaceTrust = 0.15;  // the head turns on the shoulders, and its landmarks err
    if (!known({0, 7, 8, 11, 12, 23, 24})) return 0;
    const Vec3f trunk = at(11) + at(12) - at(23) - at(24), across = at(11) + at(23) - at(12) - at(24);
    const Vec3f chest = across.cross(trunk), gaze = 2 * at(0) - at(7) - at(8);
    const double lengths = static_cast<double>(chest.norm()) * gaze.norm();
    return lengths > 1e-9 ? -kFaceTrust * chest.dot(gaze) / lengths : 0;
  }
  const bool legs = group == LimbGroup::legs;
  const int left_root = legs ? 23 : 11, right_root = left_root + 1, left = legs ? 25 : 13, right = left + 1;
  if (!known({left_root, right_root, left, right})) return 0;
  const double same = (at(left) - at(left_root)).norm() + (at(right) - at(right_root)).norm();
  const double crossed = (at(left) - at(right_root)).norm() + (at(right) - at(left_root)).norm();
  return same + crossed > 1e-6 ? (same - crossed) / (same + crossed) : 0;
}

void check_sizes(std::span<const ViewLandmarks> views) {
  for (const ViewLandmarks& view : views) {
    if (view.landmarks.size() != kLandmarkCount) {
      throw Error(ErrorCode::internal,
                  "a view has " + std::to_string(view.landmarks.size()) + " landmarks, not 33");
    }
  }
}

double combine(double a, double b, VisibilityRule rule) {
  switch (rule) {
    case VisibilityRule::minimum:
      return std::min(a, b);
    case VisibilityRule::product:
      return a * b;
    case VisibilityRule::mean:
      break;
  }
  return 0.5 * (a + b);
}

}  // namespace

Triangulation triangulate(std::span<const Camera> cameras, std::span<const ViewLandmarks> views,
                          const TriangulationSettings& settings) {
  if (cameras.size() != views.size() || cameras.size() < 2 || cameras.size() > kMostViews) {
    throw Error(ErrorCode::internal, "triangulation of " + std::to_string(views.size()) + " views with " +
                                         std::to_string(cameras.size()) + " cameras");
  }
  check_sizes(views);
  const Solver solver(cameras, views, settings);
  Triangulation result;
  result.landmarks.resize(kLandmarkCount);
  for (int l = 0; l < kLandmarkCount; ++l) result.landmarks[l] = landmark_of(solver.solve(l, l, 0));
  // The torso first: it tells which side a limb belongs to, and in which views the network took the whole
  // body's front for its back.
  Pattern torso = 0;
  for (const LimbGroup group : {LimbGroup::torso, LimbGroup::legs, LimbGroup::arms}) {
    Pattern swapped = 0;
    if (settings.find_swaps) {
      swapped = solver.best_fit(group, torso);
      place(solver, group, swapped, result.landmarks);
      swapped =
          solver.labelled(group, swapped, torso, 2 * settings.anatomy * wrong_side(group, result.landmarks));
      if (group == LimbGroup::torso) torso = swapped;
    }
    place(solver, group, swapped, result.landmarks);
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      result.swapped[static_cast<int>(group)].push_back(swapped >> v & 1);
    }
  }
  return result;
}

std::vector<Landmark3d> lift_two_views(const Camera& front, const ViewLandmarks& front_view,
                                       const Camera& side, const ViewLandmarks& side_view,
                                       VisibilityRule rule, double min_visibility) {
  check_sizes(std::array{front_view, side_view});
  const Mat3d canonical_from_body = canonical_from_body_rotation();
  const Vec3d front_centre = canonical_from_body * front.centre.cast<double>();
  const Vec3d side_centre = canonical_from_body * side.centre.cast<double>();
  const double front_width = front.width / front.pixels_per_metre,
               front_height = front.height / front.pixels_per_metre;
  const double side_width = side.width / side.pixels_per_metre,
               side_height = side.height / side.pixels_per_metre;
  const double x_max = front_centre.x() + 0.5 * front_width, x_min = front_centre.x() - 0.5 * front_width;
  const double y_max = side_centre.y() + 0.5 * side_width, y_min = side_centre.y() - 0.5 * side_width;
  const double z_max = front_centre.z() + 0.5 * front_height, z_min = front_centre.z() - 0.5 * front_height;
  const double side_z_max = side_centre.z() + 0.5 * side_height;

  std::vector<Landmark3d> landmarks;
  for (int l = 0; l < kLandmarkCount; ++l) {
    const ViewLandmark& in_front = front_view.landmarks[l];
    const ViewLandmark& in_side = side_view.landmarks[l];
    const Vec3d canonical(x_max - in_front.pixel.x() / front.width * (x_max - x_min),
                          y_min + in_side.pixel.x() / side.width * (y_max - y_min),
                          z_max - in_front.pixel.y() / front.height * (z_max - z_min));
    const double side_z = side_z_max - in_side.pixel.y() / side.height * side_height;
    const double visibility = combine(in_front.visibility, in_side.visibility, rule);
    const bool usable = canonical.allFinite() && visibility >= min_visibility;
    const Vec3d body = usable ? Vec3d(canonical_from_body.transpose() * canonical) : Vec3d(Vec3d::Zero());
    landmarks.push_back(
        {body.cast<float>(), usable ? static_cast<float>(std::clamp(visibility, 0.0, 1.0)) : 0.0f,
         usable && std::isfinite(side_z) ? static_cast<float>(std::fabs(canonical.z() - side_z)) : 0.0f});
  }
  return landmarks;
}

}  // namespace vitruvian
