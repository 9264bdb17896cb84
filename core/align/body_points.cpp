#include "align/body_points.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/random.h"
#include "geometry/kdtree.h"

namespace vitruvian {
namespace {

constexpr int kCellsAlongDiagonal = 100;

/// Occupied cells of a grid with the mean of the points in each.
struct Grid {
  double cell = 1;
  Vec3d origin = Vec3d::Zero();
  std::unordered_map<std::uint64_t, int> index;
  std::vector<Vec3d> mean;
  std::vector<int> cell_of_point;  ///< -1 for points that are not finite

  static std::uint64_t key(const Eigen::Vector3i& place) {
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(place.x()) & kMask) |
           (static_cast<std::uint64_t>(place.y()) & kMask) << 21 |
           (static_cast<std::uint64_t>(place.z()) & kMask) << 42;
  }
};

/// Diagonal of the box that holds all but the outermost two per cent on each side, and the box's centre.
std::pair<double, Vec3d> robust_box(const Points3f& vertices) {
  constexpr Index kSamples = 20000;
  const Index step = std::max<Index>(1, vertices.cols() / kSamples);
  std::vector<Vec3f> finite;
  for (Index i = 0; i < vertices.cols(); i += step) {
    if (vertices.col(i).allFinite()) finite.emplace_back(vertices.col(i));
  }
  if (finite.empty()) return {0, Vec3d::Zero()};
  Vec3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Vec3f& point : finite) values.push_back(point[axis]);
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 50;
    low[axis] = values[cut];
    high[axis] = values[values.size() - 1 - cut];
  }
  return {(high - low).norm(), 0.5 * (low + high)};
}

Grid make_grid(const Points3f& vertices) {
  const auto [diagonal, centre] = robust_box(vertices);
  Grid grid;
  grid.cell = std::max(diagonal / kCellsAlongDiagonal, 1e-30);
  grid.origin = centre;
  grid.cell_of_point.assign(static_cast<std::size_t>(vertices.cols()), -1);
  std::vector<int> count;
  constexpr double kFarthestCell = 1 << 19;
  for (Index i = 0; i < vertices.cols(); ++i) {
    const Vec3d point = vertices.col(i).cast<double>();
    const Vec3d scaled = (point - grid.origin) / grid.cell;
    if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() > kFarthestCell) continue;
    const Eigen::Vector3i place = scaled.array().floor().cast<int>();
    const auto [entry, fresh] = grid.index.try_emplace(Grid::key(place), static_cast<int>(grid.mean.size()));
    if (fresh) {
      grid.mean.push_back(Vec3d::Zero());
      count.push_back(0);
    }
    grid.mean[entry->second] += point;
    ++count[entry->second];
    grid.cell_of_point[i] = entry->second;
  }
  for (std::size_t c = 0; c < grid.mean.size(); ++c) grid.mean[c] /= count[c];
  return grid;
}

struct Plane {
  Vec3d normal = Vec3d::Zero();  ///< toward the body
  double offset = 0;
  double height(const Vec3d& point) const { return normal.dot(point) - offset; }
};

/// Whether the cells near the plane are spread like a floor and the rest lies on one side of it; turns the
/// normal there.
bool is_floor(const std::vector<Vec3d>& cells, Plane& plane, double thickness, double diagonal) {
  constexpr double kLeastShare = 0.1, kOtherSide = 0.02, kLeastSpread = 0.07;
  std::size_t on = 0, above = 0, below = 0;
  Vec3d mean = Vec3d::Zero();
  for (const Vec3d& cell : cells) {
    const double height = plane.height(cell);
    if (std::fabs(height) <= thickness) {
      ++on;
      mean += cell;
    } else {
      ++(height > 0 ? above : below);
    }
  }
  const double all = static_cast<double>(cells.size());
  if (on < kLeastShare * all || std::min(above, below) > kOtherSide * all || on > 0.9 * all) return false;
  mean /= static_cast<double>(on);
  Mat3d covariance = Mat3d::Zero();
  for (const Vec3d& cell : cells) {
    if (std::fabs(plane.height(cell)) > thickness) continue;
    covariance += (cell - mean) * (cell - mean).transpose() / static_cast<double>(on);
  }
  const Eigen::SelfAdjointEigenSolver<Mat3d> axes(covariance);
  if (std::sqrt(std::max(0.0, axes.eigenvalues()[1])) < kLeastSpread * diagonal) return false;
  // Fitting the plane to its cells makes up for the three points it was guessed from.
  Plane fitted{axes.eigenvectors().col(0), 0};
  fitted.offset = fitted.normal.dot(mean);
  if (fitted.normal.dot(plane.normal) < 0) fitted = {-fitted.normal, -fitted.offset};
  if (below > above) fitted = {-fitted.normal, -fitted.offset};
  plane = fitted;
  return true;
}

/// Whether the plane reaches beyond what stands or lies on it: most of its cells have nothing above them. The
/// flat back of a body that lay on a table is no floor.
bool reaches_beyond(const std::vector<Vec3d>& cells, const Plane& plane, double thickness, double cell) {
  constexpr double kLeastUncovered = 0.4, kTile = 2;  // share of the plane's cells; side of a tile in cells
  const Vec3d right = plane.normal.unitOrthogonal(), forward = plane.normal.cross(right);
  const auto tile = [&](const Vec3d& point) {
    return std::pair(static_cast<int>(std::floor(right.dot(point) / (kTile * cell))),
                     static_cast<int>(std::floor(forward.dot(point) / (kTile * cell))));
  };
  std::set<std::pair<int, int>> covered;
  for (const Vec3d& point : cells) {
    if (plane.height(point) <= thickness) continue;
    const auto [u, v] = tile(point);
    for (int du = -1; du <= 1; ++du) {
      for (int dv = -1; dv <= 1; ++dv) covered.emplace(u + du, v + dv);
    }
  }
  std::size_t on = 0, uncovered = 0;
  for (const Vec3d& point : cells) {
    if (std::fabs(plane.height(point)) > thickness) continue;
    ++on;
    uncovered += !covered.contains(tile(point));
  }
  return static_cast<double>(uncovered) >= kLeastUncovered * static_cast<double>(on);
}

/// Largest floor-like plane among random triples of cells; its normal is zero when there is none.
Plane find_floor(const std::vector<Vec3d>& cells, double cell) {
  constexpr int kTrials = 300;
  const double thickness = 0.75 * cell, diagonal = kCellsAlongDiagonal * cell;
  if (cells.size() < 50) return {};
  Random random(1);
  Plane best;
  std::size_t best_count = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pick = [&] { return cells[random.below(static_cast<std::uint32_t>(cells.size()))]; };
    const Vec3d a = pick(), b = pick(), c = pick(), normal = (b - a).cross(c - a);
    if (normal.norm() < 0.01 * diagonal * diagonal) continue;
    const Plane plane{normal.normalized(), normal.normalized().dot(a)};
    std::size_t count = 0;
    for (const Vec3d& point : cells) count += std::fabs(plane.height(point)) <= thickness;
    if (count > best_count) {
      best_count = count;
      best = plane;
    }
  }
  if (best_count == 0 || !is_floor(cells, best, thickness, diagonal)) return {};
  Plane again = best;
  const Plane floor = is_floor(cells, again, thickness, diagonal) ? again : best;
  return reaches_beyond(cells, floor, thickness, cell) ? floor : Plane{};
}

/// Number of each kept cell's connected group, and the groups' sizes in cells; -1 for cells left out. Cells
/// are connected by a triangle, or when nearer than three and a half cells, or than four times the usual
/// distance in sparse scans.
std::vector<int> groups_of(const Grid& grid, const Faces& faces, const std::vector<std::uint8_t>& kept,
                           std::vector<int>& sizes) {
  constexpr double kReachInCells = 3.5, kReachInSpacings = 4;
  std::vector<int> group(grid.mean.size(), -1), used;
  Points3f points(3, static_cast<Index>(grid.mean.size()));
  for (std::size_t c = 0; c < grid.mean.size(); ++c) {
    points.col(static_cast<Index>(c)) = (grid.mean[c] - grid.origin).cast<float>();
    if (kept[c]) used.push_back(static_cast<int>(c));
  }
  if (used.size() < 2) {
    for (const int c : used) group[c] = 0;
    sizes.assign(used.size(), 1);
    return group;
  }
  const KdTree tree(points, used);
  std::vector<Neighbour> neighbours;
  std::vector<float> spacings;
  for (const int c : used) {
    tree.nearest(points.col(c), 2, neighbours);
    spacings.push_back(std::sqrt(neighbours.back().squared_distance));
  }
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  const auto reach = static_cast<float>(std::max(kReachInCells * grid.cell, kReachInSpacings * *middle));

  std::vector<std::vector<int>> bridges(grid.mean.size());
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = grid.cell_of_point[faces(k, f)], b = grid.cell_of_point[faces((k + 1) % 3, f)];
      if (a < 0 || b < 0 || a == b || !kept[a] || !kept[b]) continue;
      if (bridges[a].empty() || bridges[a].back() != b) bridges[a].push_back(b);
      if (bridges[b].empty() || bridges[b].back() != a) bridges[b].push_back(a);
    }
  }

  std::vector<int> stack;
  for (const int seed : used) {
    if (group[seed] >= 0) continue;
    const int name = static_cast<int>(sizes.size());
    sizes.push_back(0);
    stack.assign(1, seed);
    group[seed] = name;
    while (!stack.empty()) {
      const int here = stack.back();
      stack.pop_back();
      ++sizes[name];
      tree.within(points.col(here), reach, neighbours);
      const auto join = [&](int cell) {
        if (group[cell] >= 0) return;
        group[cell] = name;
        stack.push_back(cell);
      };
      for (const Neighbour& neighbour : neighbours) join(neighbour.index);
      for (const int cell : bridges[here]) join(cell);
    }
  }
  return group;
}

}  // namespace

BodyPoints find_body_points(const Points3f& vertices, const Faces& faces) {
  constexpr double kSmallestPart = 0.03;  // of the largest group
  const Grid grid = make_grid(vertices);
  BodyPoints body;
  body.keep.assign(static_cast<std::size_t>(vertices.cols()), 0);

  const Plane floor = find_floor(grid.mean, grid.cell);
  body.floor_normal = floor.normal;
  body.floor_offset = floor.offset;
  body.floor_noise = 0.5 * grid.cell;
  const double clearance = 1.2 * grid.cell;
  std::vector<std::uint8_t> cell_kept(grid.mean.size(), 1);
  if (body.has_floor()) {
    for (std::size_t c = 0; c < cell_kept.size(); ++c) cell_kept[c] = floor.height(grid.mean[c]) > clearance;
  }
  std::vector<int> sizes;
  const std::vector<int> group = groups_of(grid, faces, cell_kept, sizes);
  const int largest = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
  for (std::size_t i = 0; i < body.keep.size(); ++i) {
    const int cell = grid.cell_of_point[i];
    if (cell < 0) {
      ++body.strays;
    } else if (!cell_kept[cell]) {
      ++body.floor;
    } else if (sizes[group[cell]] < kSmallestPart * largest) {
      ++body.strays;
    } else {
      body.keep[i] = 1;
    }
  }
  return body;
}

DecimatedMesh only_body(const DecimatedMesh& mesh, const BodyPoints& body) {
  DecimatedMesh result;
  std::vector<int> renumbered(body.keep.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < body.keep.size(); ++i) {
    if (body.keep[i]) renumbered[i] = count++;
  }
  result.vertices.resize(3, count);
  result.normals.resize(3, mesh.normals.cols() > 0 ? count : 0);
  for (std::size_t i = 0; i < body.keep.size(); ++i) {
    if (renumbered[i] < 0) continue;
    result.vertices.col(renumbered[i]) = mesh.vertices.col(static_cast<Index>(i));
    if (mesh.normals.cols() > 0) result.normals.col(renumbered[i]) = mesh.normals.col(static_cast<Index>(i));
    if (!mesh.source.empty()) result.source.push_back(mesh.source[i]);
  }
  result.faces.resize(3, mesh.faces.cols());
  Index kept = 0;
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    const int a = renumbered[mesh.faces(0, f)], b = renumbered[mesh.faces(1, f)],
              c = renumbered[mesh.faces(2, f)];
    if (a >= 0 && b >= 0 && c >= 0) result.faces.col(kept++) << a, b, c;
  }
  result.faces.conservativeResize(3, kept);
  return result;
}

double diameter(const Points3f& vertices, const BodyPoints& body) {
  constexpr int kDirections = 200;
  constexpr std::size_t kMostPoints = 50000;
  std::vector<Vec3d> points;
  for (Index i = 0; i < vertices.cols(); ++i) {
    if (body.keep[i]) points.push_back(vertices.col(i).cast<double>());
  }
  if (points.empty()) return 0;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kMostPoints);
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<std::size_t> ends;
  for (int k = 0; k < kDirections; ++k) {
    const double z = (k + 0.5) / kDirections, r = std::sqrt(1 - z * z), angle = golden * k;
    const Vec3d direction(r * std::cos(angle), r * std::sin(angle), z);
    std::size_t lowest = 0, highest = 0;
    for (std::size_t i = 0; i < points.size(); i += step) {
      const double value = direction.dot(points[i]);
      if (value < direction.dot(points[lowest])) lowest = i;
      if (value > direction.dot(points[highest])) highest = i;
    }
    ends.push_back(lowest);
    ends.push_back(highest);
  }
  double widest = 0;
  for (const std::size_t a : ends) {
    for (const std::size_t b : ends) widest = std::max(widest, (points[a] - points[b]).norm());
  }
  return widest;
}

Vec3d centroid(const Points3f& vertices, const Faces& faces, const BodyPoints& body) {
  Vec3d sum = Vec3d::Zero();
  double total = 0;
  for (Index f = 0; f < faces.cols(); ++f) {
    if (!body.keep[faces(0, f)] || !body.keep[faces(1, f)] || !body.keep[faces(2, f)]) continue;
    const Vec3d a = vertices.col(faces(0, f)).cast<double>(), b = vertices.col(faces(1, f)).cast<double>(),
                c = vertices.col(faces(2, f)).cast<double>();
    const double area = (b - a).cross(c - a).norm();
    sum += area * (a + b + c) / 3;
    total += area;
  }
  if (total <= 0) {
    sum.setZero();
    for (Index i = 0; i < vertices.cols(); ++i) {
      if (!body.keep[i]) continue;
      sum += vertices.col(i).cast<double>();
      total += 1;
    }
  }
  return total > 0 ? Vec3d(sum / total) : Vec3d(Vec3d::Zero());
}

}  // namespace vitruvian
