#include "detail/scan_pull.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace vitruvian {
namespace {

constexpr float kCompatible = 0.3f;  // least cosine of two normals of one surface
// The closest place on a surface lies along its normal; sideways by more than this is the rim of a hole.
constexpr float kSidewaysShare = 0.5f, kSidewaysAllowance = 0.002f;  // of the distance along; m
constexpr int kCloudNeighbours = 8;
constexpr float kOneSided = 0.8f;     // of the neighbours' distances that does not cancel out
constexpr double kFullDensity = 0.5;  // of the median number of samples an area, above which a vertex is sure

float robust_weight(float squared_distance, double scale) {
  const float squared = static_cast<float>(scale * scale);
  const float g = squared / (squared_distance + squared);
  return g * g;
}

bool compatible(const Vec3f& model_normal, const Vec3f& scan_normal) {
  return scan_normal.isZero() || model_normal.dot(scan_normal) > kCompatible;
}

/// A scan sample and the triangle it draws at; face -1: none.
struct SamplePull {
  int face = -1;
  float weight = 0;
  float along = 0;  ///< m, signed distance along the model's normal
  Vec3f barycentric, displacement;
};

[[gnu::noinline]] std::vector<SamplePull> pulls_of_samples(const SurfaceSamples& samples,
                                                           const Points3f& vertices, const Points3f& normals,
                                                           const Faces& faces, const PullSettings& settings,
                                                           const Execution& execution) {
  const ClosestPointOnMesh surface(vertices, faces);
  const Index count = (samples.points.cols() + settings.stride - 1) / settings.stride;
  std::vector<SamplePull> pulls(static_cast<std::size_t>(count));
  execution.parallel_for(count, 512, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      if (i % 4096 == 0) execution.check();
      const Index sample = i * settings.stride;
      const Vec3f point = samples.points.col(sample);
      const SurfacePoint at = surface.query(point, static_cast<float>(settings.reach));
      if (at.face < 0) continue;
      Vec3f normal = Vec3f::Zero();
      for (int k = 0; k < 3; ++k) normal += at.barycentric[k] * normals.col(faces(k, at.face));
      normal.normalize();
      if (!compatible(normal, samples.normals.col(sample))) continue;
      const Vec3f displacement = point - at.position;
      pulls[i] = {at.face, robust_weight(displacement.squaredNorm(), settings.robust_scale),
                  normal.dot(displacement), at.barycentric, displacement};
    }
  });
  return pulls;
}

/// What the scan's surface next to a vertex says; weight 0: nothing.
struct Foot {
  float weight = 0;
  Vec3f displacement = Vec3f::Zero();
};

Foot foot_on_mesh(const ScanSurface& scan, const Vec3f& x, const Vec3f& normal,
                  const PullSettings& settings) {
  const SurfacePoint at = scan.mesh->query(x, static_cast<float>(settings.reach));
  if (at.face < 0) return {};
  Vec3f there = Vec3f::Zero();
  for (int k = 0; k < 3; ++k) there += at.barycentric[k] * scan.normals.col(scan.faces(k, at.face));
  const float length = there.norm();
  if (!(length > 1e-6f)) return {};
  there /= length;
  if (!compatible(normal, there)) return {};
  const Vec3f displacement = at.position - x;
  const float along = there.dot(displacement);
  const float sideways = (displacement - along * there).norm();
  if (sideways > kSidewaysShare * std::abs(along) + kSidewaysAllowance) return {};
  return {robust_weight(displacement.squaredNorm(), settings.robust_scale), displacement};
}

/// Mean distance to the planes of the nearest points.
Foot foot_on_cloud(const ScanSurface& scan, const Vec3f& x, const Vec3f& normal, const PullSettings& settings,
                   std::vector<Neighbour>& around) {
  scan.tree.nearest(x, kCloudNeighbours, around);
  if (around.empty() || around[0].squared_distance > settings.reach * settings.reach) return {};
  Vec3f mean = Vec3f::Zero(), centre = Vec3f::Zero();
  float spread = 0, count = 0;
  for (const Neighbour& n : around) {
    const Vec3f there = scan.normals.col(n.index), away = scan.points.col(n.index) - x;
    if (!compatible(normal, there)) continue;
    const Vec3f& direction = there.isZero() ? normal : there;
    mean += direction.dot(away) * direction;
    const Vec3f sideways = away - normal.dot(away) * normal;
    centre += sideways;
    spread += sideways.norm();
    count += 1;
  }
  if (2 * count <= static_cast<float>(around.size())) return {};
  // Beyond the cloud's rim all neighbours lie to one side.
  if (centre.norm() > kOneSided * spread + count * kSidewaysAllowance) return {};
  mean /= count;
  return {robust_weight(mean.squaredNorm(), settings.robust_scale), mean};
}

[[gnu::noinline]] std::vector<Foot> feet_of_vertices(const ScanSurface& scan, const Points3f& vertices,
                                                     const Points3f& normals, const PullSettings& settings,
                                                     const Execution& execution) {
  std::vector<Foot> feet(static_cast<std::size_t>(vertices.cols()));
  execution.parallel_for(vertices.cols(), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<Neighbour> around;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      if (v % 1024 == 0) execution.check();
      const Vec3f x = vertices.col(v), normal = normals.col(v);
      feet[v] = scan.mesh != nullptr ? foot_on_mesh(scan, x, normal, settings)
                                     : foot_on_cloud(scan, x, normal, settings, around);
    }
  });
  return feet;
}

/// Cells of space near points.
class Vicinity {
 public:
  Vicinity(const Points3f& points, float reach) : low_(points.rowwise().minCoeff()), cell_(reach) {
    for (Index i = 0; i < points.cols(); ++i) {
      const Eigen::Array3i at = cell_of(points.col(i));
      for (int k = 0; k < 27; ++k)
        cells_.insert(key(at + Eigen::Array3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
    }
  }
  bool holds(const Vec3f& point) const {
    const Vec3f away = (point - low_) / cell_;
    // Also keeps the cell's numbers within an int.
    if (!(away.cwiseAbs().maxCoeff() < kMostCells)) return false;
    return cells_.count(key(cell_of(point))) > 0;
  }

 private:
  static constexpr float kMostCells = 1e6f;
  Eigen::Array3i cell_of(const Vec3f& point) const {
    return ((point - low_) / cell_).array().floor().cast<int>();
  }
  static std::uint64_t key(const Eigen::Array3i& cell) {
    std::uint64_t result = 0;
    for (int k = 0; k < 3; ++k) {
      result = result << 21 | (static_cast<std::uint64_t>(cell[k] + (1 << 20)) & ((1u << 21) - 1));
    }
    return result;
  }

  Vec3f low_;
  float cell_;
  std::unordered_set<std::uint64_t> cells_;
};

/// Median of the values; 0 of none. Reorders them.
double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

SurfaceSamples sample_near(const ScanSurface& scan, const Points3f& body, double reach, int count,
                           std::uint32_t seed) {
  const Vicinity vicinity(body, static_cast<float>(reach));
  std::vector<std::uint8_t> near(static_cast<std::size_t>(scan.points.cols()));
  Index near_points = 0;
  for (Index i = 0; i < scan.points.cols(); ++i) {
    near[i] = vicinity.holds(scan.points.col(i)) ? 1 : 0;
    near_points += near[i];
  }
  Faces faces(3, scan.faces.cols());
  Index near_faces = 0;
  for (Index f = 0; f < scan.faces.cols(); ++f) {
    if (near[scan.faces(0, f)] + near[scan.faces(1, f)] + near[scan.faces(2, f)] == 3)
      faces.col(near_faces++) = scan.faces.col(f);
  }
  if (near_faces > 0)
    return sample_surface(scan.points, faces.leftCols(near_faces), scan.normals, count, seed);
  if (scan.mesh != nullptr || near_points == 0) return {Points3f(3, 0), Points3f(3, 0), {}};

  Points3f points(3, near_points), normals(3, near_points);
  Index next = 0;
  for (Index i = 0; i < scan.points.cols(); ++i) {
    if (near[i] == 0) continue;
    points.col(next) = scan.points.col(i);
    normals.col(next++) = scan.normals.col(i);
  }
  return sample_surface(points, faces, normals, static_cast<int>(std::min<Index>(count, near_points)), seed);
}

Pull pull_of_scan(const SurfaceSamples& samples, const ScanSurface& scan, const Points3f& vertices,
                  const Points3f& normals, const Faces& faces, const Eigen::VectorXd& areas,
                  const PullSettings& settings, const Execution& execution) {
  const Index count = vertices.cols();
  const std::vector<SamplePull> drawing =
      pulls_of_samples(samples, vertices, normals, faces, settings, execution);
  const std::vector<Foot> feet = feet_of_vertices(scan, vertices, normals, settings, execution);

  // Summed in the samples' order, whatever the threads.
  Points3d sum = Points3d::Zero(3, count);
  Eigen::VectorXd share = Eigen::VectorXd::Zero(count), along = share, squared_along = share,
                  samples_near = share;
  for (const SamplePull& pull : drawing) {
    if (pull.face < 0) continue;
    for (int k = 0; k < 3; ++k) {
      const int v = faces(k, pull.face);
      const double corner = pull.barycentric[k], weight = corner * pull.weight;
      share[v] += weight;
      sum.col(v) += weight * pull.displacement.cast<double>();
      along[v] += weight * pull.along;
      squared_along[v] += weight * pull.along * pull.along;
      samples_near[v] += corner;
    }
  }
  std::vector<double> densities, spreads;
  for (Index v = 0; v < count; ++v) {
    if (share[v] > 0) densities.push_back(share[v] / areas[v]);
    if (samples_near[v] < 3) continue;
    const double mean = along[v] / share[v];
    spreads.push_back(std::sqrt(std::max(0.0, squared_along[v] / share[v] - mean * mean)));
  }
  const double density = kFullDensity * median(densities);

  Pull pull{Points3d::Zero(3, count), Eigen::VectorXd::Zero(count), median(spreads)};
  for (Index v = 0; v < count; ++v) {
    const double sure = share[v] > 0 ? std::min(1.0, share[v] / (areas[v] * density)) : 0;
    // The planes of a cloud's points are wider than its samples and flatten what is round: they only fill in.
    const double own =
        settings.foot_share * feet[v].weight * (scan.mesh != nullptr ? 1.0 : std::max(0.0, 1 - sure));
    pull.weight[v] = sure + own;
    if (pull.weight[v] <= 0) continue;
    Vec3d mean = own * feet[v].displacement.cast<double>();
    if (share[v] > 0) mean += sure / share[v] * sum.col(v);
    pull.displacement.col(v) = mean / pull.weight[v];
  }
  return pull;
}

}  // namespace vitruvian
