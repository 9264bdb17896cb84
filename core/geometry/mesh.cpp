#include "geometry/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "base/random.h"

namespace vitruvian {
namespace {

Vec3f twice_area_normal(const Points3f& vertices, const Faces& faces, Index face) {
  const Vec3f a = vertices.col(faces(0, face));
  return (vertices.col(faces(1, face)) - a).cross(vertices.col(faces(2, face)) - a);
}

void normalise_columns(Points3f& directions) {
  for (Index i = 0; i < directions.cols(); ++i) {
    const float length = directions.col(i).norm();
    if (length > 1e-20f) directions.col(i) /= length;
  }
}

}  // namespace

Points3f vertex_normals(const Points3f& vertices, const Faces& faces) {
  Points3f normals = Points3f::Zero(3, vertices.cols());
  for (Index f = 0; f < faces.cols(); ++f) {
    const Vec3f normal = twice_area_normal(vertices, faces, f);
    for (int k = 0; k < 3; ++k) normals.col(faces(k, f)) += normal;
  }
  normalise_columns(normals);
  return normals;
}

Eigen::VectorXf vertex_areas(const Points3f& vertices, const Faces& faces) {
  Eigen::VectorXf areas = Eigen::VectorXf::Zero(vertices.cols());
  for (Index f = 0; f < faces.cols(); ++f) {
    const float third = twice_area_normal(vertices, faces, f).norm() / 6;
    for (int k = 0; k < 3; ++k) areas[faces(k, f)] += third;
  }
  return areas;
}

std::vector<int> rim_vertices(const Points3f& vertices, const Faces& faces, float least_extent) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(static_cast<std::size_t>(faces.size()));
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax(int{faces(k, f)}, int{faces((k + 1) % 3, f)}));
  }
  std::sort(edges.begin(), edges.end());
  // Rims are the connected groups of the edges that are there once.
  std::vector<int> group(static_cast<std::size_t>(vertices.cols()));
  std::iota(group.begin(), group.end(), 0);
  const auto root = [&group](int v) {
    while (group[v] != v) v = group[v] = group[group[v]];
    return v;
  };
  std::vector<int> rim;
  for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
    for (next = i + 1; next < edges.size() && edges[next] == edges[i];) ++next;
    if (next > i + 1) continue;
    rim.insert(rim.end(), {edges[i].first, edges[i].second});
    group[root(edges[i].first)] = root(edges[i].second);
  }
  std::sort(rim.begin(), rim.end());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  std::unordered_map<int, Eigen::AlignedBox3f> boxes;
  for (const int v : rim) boxes[root(v)].extend(Vec3f(vertices.col(v)));
  rim.erase(std::remove_if(rim.begin(), rim.end(),
                           [&](int v) { return boxes[root(v)].diagonal().norm() < least_extent; }),
            rim.end());
  return rim;
}

double signed_volume(const Points3f& vertices, const Faces& faces) {
  double six_volumes = 0;
  for (Index f = 0; f < faces.cols(); ++f) {
    const Vec3d a = vertices.col(faces(0, f)).cast<double>(), b = vertices.col(faces(1, f)).cast<double>(),
                c = vertices.col(faces(2, f)).cast<double>();
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

SurfaceSamples sample_surface(const Points3f& vertices, const Faces& faces, const Points3f& normals,
                              int count, std::uint32_t seed) {
  Random random(seed);
  SurfaceSamples samples;
  samples.points.resize(3, count);
  samples.normals.resize(3, count);
  samples.source.resize(count);
  if (faces.cols() == 0) {
    // A cloud has no areas: a stratified choice of points, each at most once when there are enough.
    const double step = static_cast<double>(vertices.cols()) / count;
    for (int i = 0; i < count; ++i) {
      const Index point =
          std::min<Index>(vertices.cols() - 1, static_cast<Index>((i + random.uniform()) * step));
      samples.points.col(i) = vertices.col(point);
      samples.normals.col(i) = normals.col(point);
      samples.source[i] = static_cast<int>(point);
    }
    return samples;
  }
  std::vector<double> cumulative(faces.cols());
  double total = 0;
  for (Index f = 0; f < faces.cols(); ++f) {
    total += twice_area_normal(vertices, faces, f).norm();
    cumulative[f] = total;
  }
  std::size_t face = 0;
  for (int i = 0; i < count; ++i) {
    const double target = (i + random.uniform()) / count * total;
    while (face + 1 < cumulative.size() && cumulative[face] <= target) ++face;
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3f weights(static_cast<float>(1 - u - v), static_cast<float>(u), static_cast<float>(v));
    Vec3f point = Vec3f::Zero(), normal = Vec3f::Zero();
    for (int k = 0; k < 3; ++k) {
      point += weights[k] * vertices.col(faces(k, face));
      normal += weights[k] * normals.col(faces(k, face));
    }
    const float length = normal.norm();
    samples.points.col(i) = point;
    samples.normals.col(i) = length > 1e-6f ? Vec3f(normal / length) : normal;
    samples.source[i] = static_cast<int>(face);
  }
  return samples;
}

DecimatedMesh cluster_decimate(const Points3f& vertices, const Points3f& normals, const Faces& faces,
                               int target_vertices) {
  DecimatedMesh result;
  const Index count = vertices.cols();
  if (count <= target_vertices) {
    result.vertices = vertices;
    result.normals = normals;
    result.faces = faces;
    result.source.resize(count);
    std::iota(result.source.begin(), result.source.end(), 0);
    return result;
  }
  const Vec3f low = vertices.rowwise().minCoeff();
  const Vec3f extent = vertices.rowwise().maxCoeff() - low;
  // A surface of a body-like box fills about 2 x the largest face's cells; refined below until the count
  // fits.
  float cell =
      std::sqrt(2.5f * std::max({extent[0] * extent[1], extent[1] * extent[2], extent[0] * extent[2]}) /
                static_cast<float>(target_vertices));
  // Points on a line have no such faces. Cell numbers must fit 21 bits a dimension.
  const float least_cell = extent.maxCoeff() * 1e-6f + 1e-30f;
  cell = std::max({cell, least_cell, extent.maxCoeff() / static_cast<float>(target_vertices)});
  std::vector<int> cluster(count);
  int clusters = 0;
  for (int attempt = 0; attempt < 4; ++attempt) {
    std::unordered_map<std::uint64_t, int> cells;
    cells.reserve(2 * static_cast<std::size_t>(target_vertices));
    for (Index i = 0; i < count; ++i) {
      const Vec3f q = (vertices.col(i) - low) / cell;
      const std::uint64_t key = static_cast<std::uint64_t>(q[0]) << 42 |
                                static_cast<std::uint64_t>(q[1]) << 21 | static_cast<std::uint64_t>(q[2]);
      cluster[i] = cells.try_emplace(key, static_cast<int>(cells.size())).first->second;
    }
    clusters = static_cast<int>(cells.size());
    const float ratio = std::sqrt(static_cast<float>(clusters) / static_cast<float>(target_vertices));
    if (ratio > 0.85f && ratio < 1.15f) break;
    cell = std::max(least_cell, cell * ratio);
  }
  result.vertices = Points3f::Zero(3, clusters);
  result.normals = Points3f::Zero(3, clusters);
  // Summed relative to each cell's first member: exact however far from the origin or a stray the cell lies.
  std::vector<int> members(clusters, 0);
  std::vector<Index> first(clusters, 0);
  for (Index i = 0; i < count; ++i) {
    const int c = cluster[i];
    if (members[c]++ == 0) first[c] = i;
    result.vertices.col(c) += vertices.col(i) - vertices.col(first[c]);
    result.normals.col(c) += normals.col(i);
  }
  for (int c = 0; c < clusters; ++c) {
    result.vertices.col(c) = result.vertices.col(c) / static_cast<float>(members[c]) + vertices.col(first[c]);
  }
  normalise_columns(result.normals);
  result.source.assign(clusters, -1);
  std::vector<float> nearest(clusters, 0);
  for (Index i = 0; i < count; ++i) {
    const int c = cluster[i];
    const float d = (vertices.col(i) - result.vertices.col(c)).squaredNorm();
    if (result.source[c] < 0 || d < nearest[c]) result.source[c] = static_cast<int>(i), nearest[c] = d;
  }
  std::vector<std::array<int, 3>> kept;
  for (Index f = 0; f < faces.cols(); ++f) {
    const int a = cluster[faces(0, f)], b = cluster[faces(1, f)], c = cluster[faces(2, f)];
    if (a != b && b != c && a != c) kept.push_back({a, b, c});
  }
  result.faces.resize(3, static_cast<Index>(kept.size()));
  for (std::size_t f = 0; f < kept.size(); ++f) {
    for (int k = 0; k < 3; ++k) result.faces(k, static_cast<Index>(f)) = kept[f][k];
  }
  return result;
}

}  // namespace vitruvian
