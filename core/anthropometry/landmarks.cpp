#include "anthropometry/landmarks.h"

#include <algorithm>

#include "anthropometry/landmark_table.h"
#include "base/error.h"
#include "geometry/closest_point.h"

namespace vitruvian {
namespace {

Vec3d vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

Vec3d table_joint(int segment) { return vector_of(kLandmarkJoints[static_cast<std::size_t>(segment)]); }

/// The bone that a point of the default body lies at: the segment whose joint-to-joint line is nearest.
int nearest_bone(const Vec3d& point) {
  int best = 0;
  double best_distance = 1e30;
  for (int s = 0; s < kSegmentCount; ++s) {
    const int next = next_segment(s);
    const Vec3d from = table_joint(s), along = next < 0 ? Vec3d::Zero() : Vec3d(table_joint(next) - from);
    const double t =
        next < 0 ? 0 : std::clamp(along.dot(point - from) / std::max(1e-12, along.squaredNorm()), 0.0, 1.0);
    const double distance = (point - from - t * along).norm();
    if (distance < best_distance) best = s, best_distance = distance;
  }
  return best;
}

/// Moves a point with its bone from the default body's rest pose to the model's. Both rest in a T-pose, so
/// nothing is turned.
Vec3d carried_over(const Vec3d& point, const MeasuredModel& model, double across) {
  const Points3d& joints = model.body().joint_template;
  const int s = nearest_bone(point), next = next_segment(s);
  const Vec3d old_from = table_joint(s), new_from = joints.col(model.joint(s));
  const Vec3d offset = point - old_from;
  if (next < 0) return new_from + across * offset;
  const Vec3d old_bone = table_joint(next) - old_from, new_bone = joints.col(model.joint(next)) - new_from;
  const double t = old_bone.dot(offset) / std::max(1e-12, old_bone.squaredNorm());
  return new_from + t * new_bone + across * (offset - t * old_bone);
}

double joints_height(const MeasuredModel& model) {
  const Points3d& joints = model.body().joint_template;
  const int head = segment_named("head"), ankle = segment_named("left_foot");
  return joints(1, model.joint(head)) - joints(1, model.joint(ankle));
}

}  // namespace

LandmarkSet::LandmarkSet(const MeasuredModel& model) {
  const BodyModel& body = model.body();
  const ClosestPointOnMesh surface(body.v_template, body.faces);
  const double across = joints_height(model) / (table_joint(segment_named("head")).y() -
                                                table_joint(segment_named("left_foot")).y());
  for (const LandmarkPlace& place : kLandmarkTable) {
    const Vec3d target = carried_over(vector_of(place.position), model, across);
    const SurfacePoint hit = surface.query(target.cast<float>());
    if (hit.face < 0) throw Error(ErrorCode::bad_model, body.name + ": has no surface to put landmarks on");
    SurfaceLandmark landmark;
    landmark.name = place.name;
    int heaviest = 0;
    for (int k = 0; k < 3; ++k) {
      landmark.vertex[static_cast<std::size_t>(k)] = body.faces(k, hit.face);
      landmark.weight[k] = hit.barycentric[k];
      if (landmark.weight[k] > landmark.weight[heaviest]) heaviest = k;
    }
    landmark.weight /= landmark.weight.sum();
    landmark.segment =
        body.segment[static_cast<std::size_t>(landmark.vertex[static_cast<std::size_t>(heaviest)])];
    landmarks_.push_back(landmark);
  }
}

const SurfaceLandmark& LandmarkSet::named(std::string_view name) const {
  for (const SurfaceLandmark& landmark : landmarks_) {
    if (landmark.name == name) return landmark;
  }
  throw Error(ErrorCode::internal, "there is no landmark " + std::string(name));
}

}  // namespace vitruvian
