#include "fit/extremity_flip.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "fit/limb_search.h"

namespace vitruvian {
namespace {

constexpr int kMostVertices = 200;

}  // namespace

double extremity_misfit(const FitModel& model, const ScanTarget& scan, const PosedModel& posed, int limb) {
  double sum = 0;
  int count = 0;
  for (const int v : model.order) {
    const int segment = model.body.segment[v];
    if (segment != kLimbs[limb].end && segment != kLimbs[limb].tip) continue;
    const Vec3f x = posed.vertices.col(v);
    const Neighbour facing = scan.nearest(v, x, posed.normals.col(v), true);
    if (facing.index < 0) continue;
    if (scan.unseen(facing.index, (x - scan.points.col(facing.index)).squaredNorm())) continue;
    sum += std::sqrt(facing.squared_distance);
    if (++count == kMostVertices) break;
  }
  return count > 0 ? sum / count : 0;
}

std::vector<BodyState> turned_extremities(const FitModel& model, const ScanTarget& scan,
                                          const BodyState& state, double misfit) {
  PosedModel posed;
  posed.update(model, state);
  std::vector<BodyState> found;
  for (int limb = 0; limb < 4; ++limb) {
    if (extremity_misfit(model, scan, posed, limb) <= misfit) continue;
    const LimbChain& chain = kLimbs[limb];
    const Vec3d bone =
        posed.skeleton.rest_joints.col(chain.end) - posed.skeleton.rest_joints.col(chain.middle);
    if (!(bone.norm() > 0)) continue;
    BodyState turned = state;
    turned.rotation[chain.tip].setIdentity();
    turned.rotation[chain.end] =
        Eigen::AngleAxisd(std::numbers::pi, bone.normalized()).toRotationMatrix() * state.rotation[chain.end];
    found.push_back(turned);
    turned.rotation[chain.end].setIdentity();
    found.push_back(turned);
  }
  return found;
}

}  // namespace vitruvian
