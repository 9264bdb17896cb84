#pragma once

#include <array>
#include <memory>
#include <vector>

#include "anthropometry/segment_partition.h"
#include "body/forward.h"

namespace vitruvian {

/// The line from a segment's proximal to its distal joint (contract.md "Segments") and its anatomical frame.
struct SegmentAxis {
  Vec3d proximal = Vec3d::Zero(), distal = Vec3d::Zero();  ///< body frame
  /// Columns: x forward (feet and toes: dorsal), y from distal to proximal, z to the body's right; after ISB
  /// (Wu et al. 2002, 2005), from the model's joints instead of palpated points. x is the rest pose's forward
  /// direction, turned with the segment, made perpendicular to y.
  Mat3d body_from_segment = Mat3d::Identity();

  double length() const { return (distal - proximal).norm(); }
  /// The paper's c(t), appendix D.2.
  Vec3d at(double t) const { return proximal + t * (distal - proximal); }
};

/// What measuring needs of a model, made once: segments' joints and partition.
class MeasuredModel {
 public:
  /// @param model  must outlive this.
  /// @throws Error(bad_model) when a segment's joint has no counterpart in the model.
  explicit MeasuredModel(const BodyModel& model);

  const BodyModel& body() const { return *body_; }
  const SegmentPartition& partition() const { return partition_; }
  /// Joint of the model that a segment begins at.
  int joint(int segment) const { return joint_[static_cast<std::size_t>(segment)]; }
  /// Vertices of a segment, ascending.
  const std::vector<int>& vertices(int segment) const { return vertices_[static_cast<std::size_t>(segment)]; }

 private:
  const BodyModel* body_;
  std::array<int, kSegmentCount> joint_{};
  std::array<std::vector<int>, kSegmentCount> vertices_;
  SegmentPartition partition_;
};

/// A body in one shape and pose, ready to be measured. Body frame, metres.
struct Figure {
  const MeasuredModel* model;
  Points3d vertices;  ///< 3 x V
  Points3d nodes;     ///< positions of the partition's nodes
  Skeleton skeleton;
  std::array<SegmentAxis, kSegmentCount> axes;

  /// @param rest_offsets  3 x V, added to the shaped vertices before posing; or empty.
  Figure(const MeasuredModel& model, const BodyState& state, const Points3d& rest_offsets = Points3d(3, 0));
};

/// Index of a segment by its contract name; -1 when there is none.
int segment_named(std::string_view name);

/// Segment whose proximal joint is this one's distal joint; -1 for the ends of the chains.
int next_segment(int segment);

}  // namespace vitruvian
