#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "anthropometry/figure.h"
#include "geometry/plane_section.h"

namespace vitruvian {

/// A measured line whose corners lie on edges of the partition's mesh: it can be carried to another pose.
struct Tape {
  double length = 0;
  bool closed = true;
  std::vector<SectionPoint> corners;
  SectionMeasure section;  ///< of the whole curve; breadth left-right, depth front-back

  /// The same corners on another figure of the same model.
  std::vector<Vec3d> course(const Figure& figure) const;
  double length_on(const Figure& figure) const;
};

/// Lays tapes round a figure. Keeps the regions' surfaces, so make one and use it often.
class TapeMeasure {
 public:
  explicit TapeMeasure(const Figure& figure) : figure_(figure) {}

  /// The taut tape (convex hull) of the curve in which most skin of the wanted segments lies.
  /// @param region  what the plane may cut; its caps close it.
  /// @param wanted  segments that the curve must run over.
  /// @param left    left-right axis for the section's breadth.
  std::optional<Tape> girth(const Plane& plane, SegmentSet region, SegmentSet wanted, const Vec3d& left);

  /// The taut tape from one surface point to another in a plane through both: the hull of the curve's part
  /// between them that passes nearest to `over`.
  std::optional<Tape> arc(const Plane& plane, SegmentSet region, SegmentSet wanted, const Vec3d& from,
                          const Vec3d& to, const Vec3d& over);

 private:
  struct Curve {
    SectionLoop loop;
    Vec3d first, second;
  };
  const SegmentPartition::ClosedSurface& surface(SegmentSet region);
  std::optional<SectionLoop> best_curve(const Plane& plane, SegmentSet region, SegmentSet wanted);

  const Figure& figure_;
  std::map<SegmentSet, SegmentPartition::ClosedSurface> surfaces_;
};

}  // namespace vitruvian
