#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/types.h"

namespace vitruvian {

constexpr int kSegmentCount = 24;
/// A set of segments, bit s for segment s.
using SegmentSet = std::uint32_t;
constexpr SegmentSet kAllSegments = (1u << kSegmentCount) - 1;

/// A body's surface cut into its 24 segments, with caps that close each of them.
///
/// A triangle whose corners belong to different segments is cut half-way along its edges, so each vertex
/// rules its own neighbourhood. Two neighbouring segments share one cap, seen from its two sides; therefore
/// the closed volumes of all segments add up to the body's exactly, and any set of segments can be closed the
/// same way. Holes of the mesh are capped too.
///
/// Only the topology is kept: nodes are means of template vertices, so one partition serves every shape and
/// pose.
class SegmentPartition {
 public:
  /// @param faces    3 x F, indices below the number of labels
  /// @param segment  one label a vertex, 0..23
  SegmentPartition(const Faces& faces, std::span<const std::uint8_t> segment);

  /// Positions of all nodes for a shaped and posed template (3 x V): the vertices themselves come first.
  Points3d nodes(const Points3d& vertices) const;
  int node_count() const { return static_cast<int>(node_begin_.size()) - 1; }

  /// The skin of the segments in the set, open where they meet others.
  Faces skin(SegmentSet segments) const;
  /// Skin and caps: a closed surface, outward.
  struct ClosedSurface {
    Faces faces;
    std::vector<std::int8_t> segment;  ///< a face; -1 for caps
  };
  ClosedSurface closed(SegmentSet segments) const;

 private:
  using Triangle = std::array<int, 3>;
  /// The cap between two segments, seen from outside the first one. `outside` is kHole for holes of the mesh.
  struct Cap {
    int inside, outside;
    std::vector<Triangle> triangles;
  };
  static constexpr int kHole = kSegmentCount;

  int add_node(std::vector<int> mean_of);
  void cut_faces(const Faces& faces, std::span<const std::uint8_t> segment);
  void add_skin(int segment, int a, int b, int c);
  /// Adds the mean of a curve's nodes, each counted once.
  int add_apex(std::vector<int> around);
  void make_caps();
  template <typename Use>
  void for_each_skin_edge(const Use& use) const {
    for (int s = 0; s < kSegmentCount; ++s) {
      for (const Triangle& t : skin_[static_cast<std::size_t>(s)]) {
        for (std::size_t k = 0; k < 3; ++k) use(s, t[k], t[(k + 1) % 3]);
      }
    }
  }

  std::vector<int> node_begin_;  ///< nodes + 1, into node_source_
  std::vector<int> node_source_;
  std::array<std::vector<Triangle>, kSegmentCount> skin_;
  std::vector<Cap> caps_;
};

}  // namespace vitruvian
