#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "align/body_points.h"
#include "fit/scan_target.h"
#include "geometry/mesh.h"
#include "geometry/scan_surface.h"
#include "io/scan.h"
#include "keypoints/views.h"

namespace vitruvian {

/// A scan in its file's frame and units (relative to scan.origin), with what does not depend on how it is
/// aligned.
struct PreparedScan {
  std::shared_ptr<const Scan> owner;
  const Scan& scan;
  Points3f normals;     ///< unit, outward
  ViewSurface surface;  ///< coarse copy for pictures, without floor and strays, file units
  /// What the body is fitted to and measured against: all of the scan but a floor. Indices of vertices
  /// (empty: all), and the triangles that have all corners among them.
  std::vector<int> body_vertices;
  const Faces& body_faces() const { return body_vertices.empty() ? scan.faces : faces_off_floor_; }
  Points3f rim;    ///< points on the rims of the scan's holes, as scan.vertices; none for a cloud
  Vec3d centroid;  ///< scan frame: area-weighted mean of the coarse copy
  double extent;   ///< largest distance between two of its points, file units

  /// @throws Error(no_geometry).
  PreparedScan(std::shared_ptr<const Scan> scan, const Execution& execution);
  PreparedScan(Scan scan, const Execution& execution);

 private:
  void leave_out_floor(const BodyPoints& found);

  Faces faces_off_floor_;
};

/// A scan placed in the body frame, metres, with its search structures.
class PlacedScan {
 public:
  /// @param body_from_scan  similarity; @param prepared must outlive this object.
  PlacedScan(const PreparedScan& prepared, const Mat4d& body_from_scan, const Execution& execution);

  const Points3f& points() const { return points_; }
  const Points3f& normals() const { return normals_; }
  ScanSurface surface() const {
    return {points_, normals_, *faces_, tree_, mesh_ ? &*mesh_ : nullptr, prepared_->body_vertices};
  }

 private:
  const PreparedScan* prepared_;
  Points3f points_, normals_;
  const Faces* faces_;
  KdTree tree_;
  std::optional<ClosestPointOnMesh> mesh_;
};

/// Points of the scan's body for the fit, spread evenly, from its vertices and normals placed in the body
/// frame.
/// @param labels  of the scan's own vertices.
ScanTarget sample_body(const PreparedScan& prepared, const Points3f& points, const Points3f& normals,
                       const Mat4d& body_from_scan, int count, std::uint32_t seed,
                       const RegionLabels& labels = {});

/// Points given relative to `origin` in the scan frame, taken to the body frame.
Points3f transform_points(const Points3f& points, const Vec3d& origin, const Mat4d& body_from_scan);

}  // namespace vitruvian
