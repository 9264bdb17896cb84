#include "fit/limb_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

namespace vitruvian {
namespace {

constexpr int kLimbVertices = 140;
constexpr int kModelVertices = 4500;
constexpr int kScanPoints = 2500;
// A first look at the whole library with few points picks those that deserve all of them.
constexpr int kFirstLookVertices = 36;
constexpr int kFirstLookPoints = 160;
constexpr std::size_t kSecondLook = 40;
constexpr float kUnexplained = 0.05f;  // m
constexpr float kLargestDistance = 0.2f;
constexpr int kLeastUnexplained = 60;  // few points must not decide alone
constexpr double kDistinct = 0.5;      // rad

bool belongs(const LimbChain& limb, int joint) {
  return joint == limb.root || joint == limb.middle || joint == limb.end || joint == limb.tip;
}

Mat3d rotation_of(const Vec3d& axis_angle) {
  const double angle = axis_angle.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, axis_angle / angle).toRotationMatrix() : Mat3d::Identity();
}

/// A joint and all below it, parents first.
std::vector<int> joints_from(const FitModel& model, int joint) {
  std::vector<int> below;
  for (int j = 0; j < model.body.joint_count(); ++j) {
    if (model.groups.ancestors[j] >> joint & 1) below.push_back(j);
  }
  return below;
}

/// Vertices of the limb in a new pose of its root and middle joint; `moved` are the limb's joints.
[[gnu::noinline]] void pose_limb(const FitModel& model, const BodyState& state, const PosedModel& posed,
                                 std::span<const int> moved, std::span<const int> vertices,
                                 Points3f& result) {
  const BodyModel& body = model.body;
  Skeleton skeleton = posed.skeleton;
  for (const int j : moved) {
    const int p = body.parent[j];
    skeleton.global[j] = skeleton.global[p] * state.rotation[j];
    skeleton.joints.col(j) = skeleton.joints.col(p) +
                             skeleton.global[p] * (skeleton.rest_joints.col(j) - skeleton.rest_joints.col(p));
  }
  result.resize(3, static_cast<Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    Vec3f x = Vec3f::Zero();
    for (Index k = 0; k < body.skin_joint.rows(); ++k) {
      const float weight = body.skin_weight(k, v);
      if (weight == 0) break;
      const int j = body.skin_joint(k, v);
      const Vec3d rest = posed.rest.col(v).cast<double>() - skeleton.rest_joints.col(j);
      x += weight * (skeleton.global[j] * rest + skeleton.joints.col(j)).cast<float>();
    }
    result.col(static_cast<Index>(i)) = x;
  }
}

[[gnu::noinline]] double cost_of(const Points3f& limb_points, const ScanTarget& scan,
                                 std::span<const Vec3f> unexplained, std::size_t all_unexplained) {
  double to_scan = 0;
  for (Index i = 0; i < limb_points.cols(); ++i) {
    const float squared = scan.by_position.nearest(limb_points.col(i)).squared_distance;
    to_scan += std::min(kLargestDistance, std::sqrt(squared));
  }
  double to_limb = 0;
  for (const Vec3f& y : unexplained) {
    const float squared = (limb_points.colwise() - y).colwise().squaredNorm().minCoeff();
    to_limb += std::min(kLargestDistance, std::sqrt(squared));
  }
  return to_scan / static_cast<double>(std::max<Index>(1, limb_points.cols())) +
         to_limb / std::max<double>(1, static_cast<double>(unexplained.size())) *
             std::min(1.0, static_cast<double>(all_unexplained) / kLeastUnexplained);
}

}  // namespace

std::vector<BodyState> search_limb(const FitModel& model, const ScanTarget& scan, const BodyState& state,
                                   int limb_index, int count) {
  const LimbChain& limb = kLimbs[limb_index];
  PosedModel posed;
  posed.update(model, state);
  std::vector<int> limb_vertices, other_vertices;
  for (int i = 0; i < std::min<int>(kModelVertices, static_cast<int>(model.order.size())); ++i) {
    const int v = model.order[i];
    if (belongs(limb, model.body.segment[v])) {
      if (static_cast<int>(limb_vertices.size()) < kLimbVertices) limb_vertices.push_back(v);
    } else {
      other_vertices.push_back(v);
    }
  }
  const KdTree rest_of_body(posed.vertices, other_vertices);
  std::vector<Vec3f> unexplained;
  for (Index i = 0; i < std::min<Index>(kScanPoints, scan.points.cols()); ++i) {
    const Vec3f y = scan.points.col(i);
    if (rest_of_body.nearest(y).squared_distance > kUnexplained * kUnexplained) unexplained.push_back(y);
  }

  const auto& library = model.prior.limbs[limb_index].configurations;
  const auto upper = [&](Index c) { return rotation_of(library.col(c).head<3>()); };
  const auto lower = [&](Index c) { return rotation_of(library.col(c).tail<3>()); };
  std::vector<std::pair<double, Index>> ranking;
  BodyState candidate = state;
  const std::vector<int> moved = joints_from(model, limb.root);
  for (const int j : joints_from(model, limb.end)) candidate.rotation[j].setIdentity();
  Points3f points;
  const auto cost = [&](Index c, std::span<const int> vertices, std::span<const Vec3f> targets) {
    candidate.rotation[limb.root] = upper(c);
    candidate.rotation[limb.middle] = lower(c);
    pose_limb(model, candidate, posed, moved, vertices, points);
    return cost_of(points, scan, targets, unexplained.size());
  };
  const auto head = [](auto& list, int count) {
    return std::span(list).first(std::min<std::size_t>(list.size(), static_cast<std::size_t>(count)));
  };
  for (Index c = 0; c < library.cols(); ++c) {
    ranking.emplace_back(
        cost(c, head(limb_vertices, kFirstLookVertices), head(unexplained, kFirstLookPoints)), c);
  }
  std::sort(ranking.begin(), ranking.end());
  if (ranking.size() > kSecondLook) ranking.resize(kSecondLook);
  for (auto& [value, c] : ranking) value = cost(c, limb_vertices, unexplained);
  std::sort(ranking.begin(), ranking.end());

  std::vector<BodyState> result;
  std::vector<Index> taken;
  for (const auto& ranked : ranking) {
    const Index c = ranked.second;
    const bool distinct = std::all_of(taken.begin(), taken.end(), [&](Index t) {
      return Eigen::AngleAxisd(Mat3d(upper(t).transpose() * upper(c))).angle() >= kDistinct;
    });
    if (!distinct) continue;
    taken.push_back(c);
    candidate.rotation[limb.root] = upper(c);
    candidate.rotation[limb.middle] = lower(c);
    result.push_back(candidate);
    if (static_cast<int>(result.size()) >= count) break;
  }
  return result;
}

}  // namespace vitruvian
