#include "pipeline/prepared_scan.h"

#include <Eigen/LU>
#include <cmath>

#include "align/body_points.h"

namespace vitruvian {
namespace {

constexpr int kCoarseVertices = 40000;
constexpr int kCloudNeighbours = 12;
constexpr double kLeastRim = 0.03;  // of the body's extent: some 5 cm
constexpr float kRimReach = 0.02f;  // m
constexpr Index kLargestCloudForNormals = 150000;

/// Normals of a cloud: of a thinned copy when it is large, each point then takes those of its nearest sample.
Points3f cloud_normals(const Points3f& points, const Execution& execution) {
  if (points.cols() <= kLargestCloudForNormals)
    return point_cloud_normals(points, kCloudNeighbours, execution);
  const DecimatedMesh thin =
      cluster_decimate(points, Points3f::Zero(3, points.cols()), Faces(3, 0), kLargestCloudForNormals);
  const Points3f thin_normals = point_cloud_normals(thin.vertices, kCloudNeighbours, execution);
  const KdTree tree(thin.vertices);
  Points3f normals(3, points.cols());
  execution.parallel_for(points.cols(), 4096, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      normals.col(i) = thin_normals.col(tree.nearest(points.col(i)).index);
  });
  return normals;
}

Points3f initial_normals(const Scan& scan, const Execution& execution) {
  if (scan.faces.cols() > 0) return vertex_normals(scan.vertices, scan.faces);
  if (scan.normals.cols() == scan.vertices.cols()) return scan.normals.colwise().normalized();
  return cloud_normals(scan.vertices, execution);
}

}  // namespace

PreparedScan::PreparedScan(Scan given, const Execution& execution)
    : PreparedScan(std::make_shared<const Scan>(std::move(given)), execution) {}

PreparedScan::PreparedScan(std::shared_ptr<const Scan> given, const Execution& execution)
    : owner(std::move(given)), scan(*owner) {
  normals = initial_normals(scan, execution);
  execution.progress("align", 0.2);
  DecimatedMesh coarse = cluster_decimate(scan.vertices, normals, scan.faces, kCoarseVertices);
  // A million scattered points share hardly a triangle after clustering: then the vertices alone are the
  // surface.
  if (scan.faces.cols() > 0 && coarse.faces.cols() < coarse.vertices.cols() / 2) coarse.faces.resize(3, 0);
  // Strays and a floor would shrink the body in the pictures and cover its feet.
  const BodyPoints found = find_body_points(coarse.vertices, coarse.faces);
  coarse = only_body(coarse, found);
  leave_out_floor(found);
  const std::vector<int> source = coarse.source;
  surface = prepare_surface(std::move(coarse.vertices), std::move(coarse.faces), std::move(coarse.normals),
                            execution);
  // prepare_surface() found out which side is outside; turn our normals when most of them disagree.
  double agreement = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    agreement += normals.col(source[i]).dot(surface.normals.col(static_cast<Index>(i))) > 0 ? 1 : -1;
  }
  if (agreement < 0) normals *= -1;
  const BodyPoints all{std::vector<std::uint8_t>(surface.vertices.cols(), 1)};
  centroid = scan.origin + vitruvian::centroid(surface.vertices, surface.faces, all);
  extent = diameter(surface.vertices, all);
  // The coarse copy has no seams and cracks, which a file's own triangles may have everywhere.
  const std::vector<int> on_rim =
      rim_vertices(surface.vertices, surface.faces, static_cast<float>(kLeastRim * extent));
  rim.resize(3, static_cast<Index>(on_rim.size()));
  for (Index i = 0; i < rim.cols(); ++i) rim.col(i) = surface.vertices.col(on_rim[i]);
}

void PreparedScan::leave_out_floor(const BodyPoints& found) {
  if (!found.has_floor()) return;
  std::vector<std::uint8_t> kept(scan.vertices.cols());
  for (Index i = 0; i < scan.vertices.cols(); ++i) {
    kept[i] = !found.on_floor(scan.vertices.col(i).cast<double>());
    if (kept[i]) body_vertices.push_back(static_cast<int>(i));
  }
  Index used = 0;
  const Faces& all = scan.faces;
  faces_off_floor_.resize(3, all.cols());
  for (Index f = 0; f < all.cols(); ++f) {
    if (kept[all(0, f)] && kept[all(1, f)] && kept[all(2, f)]) faces_off_floor_.col(used++) = all.col(f);
  }
  faces_off_floor_.conservativeResize(3, used);
}

ScanTarget sample_body(const PreparedScan& prepared, const Points3f& points, const Points3f& normals,
                       const Mat4d& body_from_scan, int count, std::uint32_t seed,
                       const RegionLabels& labels) {
  ScanTarget target;
  if (prepared.body_vertices.empty() || prepared.body_faces().cols() > 0) {
    target = ScanTarget::sample(points, prepared.body_faces(), normals, count, seed, labels);
  } else {
    Points3f own(3, static_cast<Index>(prepared.body_vertices.size())), own_normals(3, own.cols());
    RegionLabels own_labels{labels.count, {}, labels.vertices};
    for (Index i = 0; i < own.cols(); ++i) {
      const int v = prepared.body_vertices[i];
      own.col(i) = points.col(v);
      own_normals.col(i) = normals.col(v);
      if (labels.count > 1) own_labels.scan.push_back(labels.of_point(v));
    }
    target = ScanTarget::sample(own, prepared.body_faces(), own_normals, count, seed, own_labels);
  }
  target.mark_rim(transform_points(prepared.rim, prepared.scan.origin, body_from_scan), kRimReach);
  return target;
}

Points3f transform_points(const Points3f& points, const Vec3d& origin, const Mat4d& body_from_scan) {
  const Mat3f linear = body_from_scan.topLeftCorner<3, 3>().cast<float>();
  const Vec3f shift =
      (body_from_scan.topLeftCorner<3, 3>() * origin + body_from_scan.topRightCorner<3, 1>()).cast<float>();
  Points3f result(3, points.cols());
  result.noalias() = linear * points;
  result.colwise() += shift;
  return result;
}

PlacedScan::PlacedScan(const PreparedScan& prepared, const Mat4d& body_from_scan, const Execution& execution)
    : prepared_(&prepared), faces_(&prepared.body_faces()) {
  points_ = transform_points(prepared.scan.vertices, prepared.scan.origin, body_from_scan);
  const Mat3d linear = body_from_scan.topLeftCorner<3, 3>();
  const Mat3f rotation = (linear / std::cbrt(linear.determinant())).cast<float>();
  normals_.noalias() = rotation * prepared.normals;
  execution.parallel_for(2, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t job = begin; job < end; ++job) {
      if (job == 0) tree_ = KdTree(points_, prepared.body_vertices);
      if (job == 1 && faces_->cols() > 0) mesh_.emplace(points_, *faces_);
    }
  });
}

}  // namespace vitruvian
