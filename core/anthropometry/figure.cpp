#include "anthropometry/figure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "base/error.h"

namespace vitruvian {
namespace {

// By segment: hips, legs, spine ... in contract order. -1: the distal end is the farthest vertex along the
// bone.
constexpr std::array<int, kSegmentCount> kNext = {3,  4,  5,  6,  7,  8,  9,  10, 11, 12, -1, -1,
                                                  15, 16, 17, -1, 18, 19, 20, 21, 22, 23, -1, -1};
// Segment whose joint gives the bone's direction at the ends of the chains.
constexpr std::array<int, kSegmentCount> kBefore = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 7,  8,
                                                    -1, -1, -1, 12, -1, -1, -1, -1, -1, -1, 20, 21};

bool is_foot(int segment) { return (segment >= 7 && segment <= 8) || (segment >= 10 && segment <= 11); }

int joint_of(const BodyModel& body, int segment) {
  const std::string name(kSmplJointNames[static_cast<std::size_t>(segment)]);
  std::vector<std::string> candidates = {name};
  // Models with fingers have no hand joint: the middle finger's knuckle stands for it.
  if (segment >= 22) {
    const std::string side = name.substr(0, name.find('_'));
    candidates.insert(candidates.end(), {side + "_middle1", side + "_index1"});
  }
  for (const std::string& candidate : candidates) {
    const auto found = std::find(body.joint_names.begin(), body.joint_names.end(), candidate);
    if (found != body.joint_names.end()) return static_cast<int>(found - body.joint_names.begin());
  }
  throw Error(ErrorCode::bad_model,
              body.name + ": has no joint " + name + ", so its segments cannot be measured");
}

/// Vertex of an end segment that lies farthest along the bone, in the shaped rest pose: the same one in every
/// pose.
int end_vertex(const MeasuredModel& model, int segment, const Points3d& rest, const Points3d& rest_joints) {
  const std::vector<int>& own = model.vertices(segment);
  if (own.empty()) return -1;
  const Vec3d from = rest_joints.col(model.joint(kBefore[static_cast<std::size_t>(segment)]));
  const Vec3d direction = rest_joints.col(model.joint(segment)) - from;
  return *std::max_element(own.begin(), own.end(), [&](int a, int b) {
    return direction.dot(rest.col(a)) < direction.dot(rest.col(b));
  });
}

}  // namespace

int segment_named(std::string_view name) {
  const auto found = std::find(kSegmentNames.begin(), kSegmentNames.end(), name);
  return found == kSegmentNames.end() ? -1 : static_cast<int>(found - kSegmentNames.begin());
}

int next_segment(int segment) { return kNext[static_cast<std::size_t>(segment)]; }

MeasuredModel::MeasuredModel(const BodyModel& model) : body_(&model), partition_(model.faces, model.segment) {
  for (int s = 0; s < kSegmentCount; ++s) joint_[static_cast<std::size_t>(s)] = joint_of(model, s);
  for (int v = 0; v < model.vertex_count(); ++v) {
    vertices_[model.segment[static_cast<std::size_t>(v)]].push_back(v);
  }
}

Figure::Figure(const MeasuredModel& measured, const BodyState& state, const Points3d& rest_offsets)
    : model(&measured), skeleton(pose_skeleton(measured.body(), state)) {
  const BodyModel& body = measured.body();
  VertexMatrix<double> rest;
  shape_vertices(body, state.betas, rest);
  if (rest_offsets.cols() > 0) {
    if (rest_offsets.cols() != rest.cols())
      throw Error(ErrorCode::internal, "offsets do not fit the body model");
    rest += rest_offsets;
  }
  std::array<int, kSegmentCount> ends{};
  for (int s = 0; s < kSegmentCount; ++s) {
    ends[static_cast<std::size_t>(s)] =
        next_segment(s) < 0 ? end_vertex(measured, s, rest, skeleton.rest_joints) : -1;
  }
  add_correctives(body, state, rest);
  skin_vertices(body, skeleton, rest, vertices);
  nodes = measured.partition().nodes(vertices);
  for (int s = 0; s < kSegmentCount; ++s) {
    SegmentAxis& axis = axes[static_cast<std::size_t>(s)];
    const int joint = measured.joint(s), end = ends[static_cast<std::size_t>(s)], next = next_segment(s);
    axis.proximal = skeleton.joints.col(joint);
    axis.distal = next >= 0  ? Vec3d(skeleton.joints.col(measured.joint(next)))
                  : end >= 0 ? Vec3d(vertices.col(end))
                             : axis.proximal;
    const Mat3d& turned = skeleton.global[static_cast<std::size_t>(joint)];
    const Vec3d y =
        axis.length() > 0 ? Vec3d((axis.proximal - axis.distal) / axis.length()) : Vec3d(turned.col(1));
    Vec3d x = is_foot(s) ? turned.col(1) : turned.col(2);
    x -= y * y.dot(x);
    if (x.norm() < 1e-6) x = y.unitOrthogonal();
    x.normalize();
    axis.body_from_segment << x, y, x.cross(y);
  }
}

}  // namespace vitruvian
