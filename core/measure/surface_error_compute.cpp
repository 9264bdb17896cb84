#include "measure/surface_error_compute.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "base/random.h"
#include "body/model.h"
#include "geometry/mesh.h"
#include "measure/correspondence.h"
#include "measure/statistics.h"

namespace vitruvian {
namespace {

constexpr int kPlaneNeighbours = 12;
constexpr int kScanSamples = 50000;
constexpr std::uint32_t kSamplingSeed = 20;

void check_sizes(const PosedTemplate& model, const ScanSurface& scan) {
  const Index vertices = model.vertices.cols();
  if (vertices == 0 || model.normals.cols() != vertices ||
      static_cast<Index>(model.segment.size()) != vertices || model.faces.cols() == 0) {
    throw Error(ErrorCode::internal, "surface error: the template's arrays differ in size or are empty");
  }
  if (scan.points.cols() == 0 || scan.normals.cols() != scan.points.cols() || scan.tree.empty() ||
      (scan.mesh != nullptr && scan.faces.cols() == 0)) {
    throw Error(ErrorCode::internal, "surface error: the scan's arrays differ in size or are empty");
  }
}

bool compatible(const Vec3f& template_normal, const Vec3f& scan_normal) {
  const float length = scan_normal.norm();
  return length == 0 || template_normal.dot(scan_normal) > kCompatibleCosine * length;
}

/// Scan normal at a point of a triangle, interpolated: the winding of a scan's triangles is not trusted.
Vec3f surface_normal_at(const ScanSurface& scan, const SurfacePoint& at) {
  Vec3f sum = Vec3f::Zero();
  for (int k = 0; k < 3; ++k) sum += at.barycentric[k] * scan.normals.col(scan.faces(k, at.face));
  return sum;
}

/// One template vertex's view of the scan.
struct VertexView {
  float surface_distance;
  bool observed;
  bool opposed;  ///< near the scan's surface, but facing against it
};

VertexView look_from_vertex(const Vec3f& vertex, const Vec3f& normal, const ScanSurface& scan,
                            std::vector<Neighbour>& scratch) {
  VertexView view{};
  const Neighbour nearest = scan.tree.nearest(vertex);
  const float nearest_distance = std::sqrt(nearest.squared_distance);
  Vec3f surface_normal = scan.normals.col(nearest.index);
  if (scan.mesh != nullptr) {
    const SurfacePoint closest = scan.mesh->query(vertex);
    view.surface_distance = closest.distance;
    surface_normal = surface_normal_at(scan, closest);
    view.observed = closest.distance <= kObservedDistance && compatible(normal, surface_normal);
  } else {
    view.surface_distance = distance_to_cloud(vertex, scan.points, scan.tree);
  }
  view.opposed = view.surface_distance <= kObservedDistance && normal.dot(surface_normal) < 0;
  if (!view.observed && nearest_distance <= kObservedDistance) {
    view.observed = compatible(normal, scan.normals.col(nearest.index));
    if (!view.observed) {
      scan.tree.within(vertex, kObservedDistance, scratch);
      view.observed = std::any_of(scratch.begin(), scratch.end(), [&](const Neighbour& neighbour) {
        return compatible(normal, scan.normals.col(neighbour.index));
      });
    }
  }
  return view;
}

/// The table of one measure; fills `all` with the pooled statistics of the rows that have any.
std::vector<SegmentError> table(const std::vector<float>& distances, std::span<const std::uint8_t> segment,
                                const std::vector<std::uint8_t>& observed, DistanceStatistics& all) {
  std::vector<SegmentError> rows;
  std::vector<float> pooled;
  for (std::size_t s = 0; s < kSegmentNames.size(); ++s) {
    std::vector<float> own;
    std::size_t seen = 0;
    for (std::size_t v = 0; v < distances.size(); ++v) {
      if (segment[v] != s) continue;
      own.push_back(distances[v]);
      seen += observed[v];
    }
    SegmentError row;
    row.segment = kSegmentNames[s];
    row.observed = own.empty() ? 0 : static_cast<double>(seen) / static_cast<double>(own.size());
    if (row.observed >= kObservedShare) {
      pooled.insert(pooled.end(), own.begin(), own.end());
      row.statistics = distance_statistics(std::move(own));
    }
    rows.push_back(std::move(row));
  }
  all = distance_statistics(std::move(pooled));
  return rows;
}

/// One index out of each of `count` equal runs of [0, size), so that rows of a structured scan do not alias.
std::vector<int> spread_indices(Index size, int count) {
  std::vector<int> indices;
  if (size <= count) {
    indices.resize(static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<int>(i);
    return indices;
  }
  Random random(kSamplingSeed);
  const double run = static_cast<double>(size) / count;
  for (int k = 0; k < count; ++k) {
    indices.push_back(
        static_cast<int>(std::min<Index>(size - 1, static_cast<Index>((k + random.uniform()) * run))));
  }
  return indices;
}

}  // namespace

float distance_to_cloud(const Vec3f& point, const Points3f& cloud, const KdTree& tree) {
  const Neighbour nearest = tree.nearest(point);
  std::vector<Neighbour> around;
  tree.nearest(cloud.col(nearest.index), kPlaneNeighbours, around);
  const float to_nearest = std::sqrt(nearest.squared_distance);
  if (around.size() < 3) return to_nearest;

  Vec3d centre = Vec3d::Zero();
  for (const Neighbour& n : around) centre += cloud.col(n.index).cast<double>();
  centre /= static_cast<double>(around.size());
  Mat3d covariance = Mat3d::Zero();
  double squared_radius = 0;
  for (const Neighbour& n : around) {
    const Vec3d d = cloud.col(n.index).cast<double>() - centre;
    covariance += d * d.transpose();
    squared_radius = std::max(squared_radius, d.squaredNorm());
  }
  const Eigen::SelfAdjointEigenSolver<Mat3d> axes(covariance);
  const Vec3d normal = axes.eigenvectors().col(0);
  const Vec3d offset = point.cast<double>() - centre;
  const double along = normal.dot(offset);
  const double across = std::max(0.0, (offset - along * normal).norm() - std::sqrt(squared_radius));
  return std::min(to_nearest, static_cast<float>(std::hypot(along, across)));
}

SurfaceMeasurement measure_surface(const PosedTemplate& model, const ScanSurface& scan,
                                   const Execution& execution) {
  check_sizes(model, scan);
  const auto vertices = static_cast<std::size_t>(model.vertices.cols());
  SurfaceMeasurement result;
  result.matched_point = rematch(model.vertices, scan.points, scan.tree, execution);
  result.point_distance_m.resize(vertices);
  result.surface_distance_m.resize(vertices);
  result.observed.resize(vertices);
  std::vector<std::uint8_t> opposed(vertices);
  execution.parallel_for(model.vertices.cols(), 64, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<Neighbour> scratch;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      if (v % 256 == 0) execution.check();
      const VertexView view = look_from_vertex(model.vertices.col(v), model.normals.col(v), scan, scratch);
      result.point_distance_m[v] = (model.vertices.col(v) - scan.points.col(result.matched_point[v])).norm();
      result.surface_distance_m[v] = view.surface_distance;
      result.observed[v] = view.observed ? 1 : 0;
      opposed[v] = view.opposed ? 1 : 0;
    }
  });

  const ClosestPointOnMesh model_surface(model.vertices, model.faces);
  const bool whole = scan.body.empty();
  result.sampled_point =
      spread_indices(whole ? scan.points.cols() : static_cast<Index>(scan.body.size()), kScanSamples);
  if (!whole) {
    for (int& point : result.sampled_point) point = scan.body[point];
  }
  const auto samples = static_cast<std::ptrdiff_t>(result.sampled_point.size());
  result.sampled_distance_m.resize(result.sampled_point.size());
  result.sampled_vertex.resize(result.sampled_point.size());
  execution.parallel_for(samples, 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      if (k % 256 == 0) execution.check();
      const SurfacePoint closest = model_surface.query(scan.points.col(result.sampled_point[k]));
      Index corner = 0;
      closest.barycentric.maxCoeff(&corner);
      result.sampled_distance_m[k] = closest.distance;
      result.sampled_vertex[k] = model.faces(corner, closest.face);
    }
  });

  SurfaceError& error = result.error;
  error.observed = static_cast<double>(std::count(result.observed.begin(), result.observed.end(), 1)) /
                   static_cast<double>(vertices);
  error.segments = table(result.point_distance_m, model.segment, result.observed, error.all);
  error.surface_segments =
      table(result.surface_distance_m, model.segment, result.observed, error.surface_all);
  error.scan_to_model = distance_statistics(result.sampled_distance_m);

  // By area: two thirds of the vertices sit in head, hands and feet.
  const Eigen::VectorXf area = vertex_areas(model.vertices, model.faces);
  std::array<double, 24> near_area{}, opposed_area{};
  for (std::size_t v = 0; v < vertices; ++v) {
    if (result.surface_distance_m[v] > kObservedDistance) continue;
    near_area[model.segment[v]] += area[static_cast<Index>(v)];
    if (opposed[v] != 0) opposed_area[model.segment[v]] += area[static_cast<Index>(v)];
  }
  for (std::size_t s = 0; s < near_area.size(); ++s)
    result.segment_opposed_share.push_back(near_area[s] > 0 ? opposed_area[s] / near_area[s] : 0);
  const double all_near = std::accumulate(near_area.begin(), near_area.end(), 0.0);
  if (all_near > 0)
    result.opposed_share = std::accumulate(opposed_area.begin(), opposed_area.end(), 0.0) / all_near;
  return result;
}

}  // namespace vitruvian
