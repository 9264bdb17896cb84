#include "geometry/convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

__extension__ using Int128 = __int128;
using GridPoint = Eigen::Matrix<std::int64_t, 3, 1>;

constexpr double kGrid = 16777216.0;  // 2^24 cells: differences take 25 bits, a determinant at most 79
constexpr double kThin = 1e-6;        // of the extent

GridPoint cross(const GridPoint& a, const GridPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Int128 dot(const GridPoint& a, const GridPoint& b) {
  return static_cast<Int128>(a[0]) * b[0] + static_cast<Int128>(a[1]) * b[1] +
         static_cast<Int128>(a[2]) * b[2];
}

double length(const GridPoint& a) { return a.cast<double>().norm(); }

struct Face {
  std::array<int, 3> corner;
  GridPoint normal;
  Int128 offset;
};

/// Grows a hull point by point.
class HullBuilder {
 public:
  explicit HullBuilder(std::vector<GridPoint> points) : points_(std::move(points)) {}

  HullDefect build() {
    if (const HullDefect defect = start(); defect != HullDefect::none) return defect;
    // In a random order few points are outside of the hull so far.
    std::vector<int> order(points_.size());
    std::iota(order.begin(), order.end(), 0);
    Random random(1);
    for (std::size_t i = order.size(); i > 1; --i) {
      std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    }
    for (const int point : order) insert(point);
    return HullDefect::none;
  }

  const std::vector<Face>& faces() const { return faces_; }

 private:
  void add(int a, int b, int c) {
    const GridPoint normal = cross(points_[b] - points_[a], points_[c] - points_[a]);
    faces_.push_back({{a, b, c}, normal, dot(normal, points_[a])});
  }

  /// Index of the largest value(point), which the caller knows how to judge.
  template <typename Value>
  int largest(const Value& value) const {
    int best = 0;
    double best_value = -1;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double v = value(points_[i]);
      if (v > best_value) best = static_cast<int>(i), best_value = v;
    }
    return best;
  }

  HullDefect start() {
    if (points_.size() < 4) return HullDefect::too_few_points;
    const GridPoint origin = points_[0];
    const int b = largest([&](const GridPoint& p) { return length(p - origin); });
    const GridPoint line = points_[b] - origin;
    if (length(line) < 1) return HullDefect::coincident;
    const int c = largest([&](const GridPoint& p) { return length(cross(line, p - origin)); });
    const GridPoint normal = cross(line, points_[c] - origin);
    if (length(normal) <= kThin * kGrid * length(line)) return HullDefect::collinear;
    const auto height = [&](const GridPoint& p) { return static_cast<double>(dot(normal, p - origin)); };
    const int d = largest([&](const GridPoint& p) { return std::abs(height(p)); });
    if (std::abs(height(points_[d])) <= kThin * kGrid * length(normal)) return HullDefect::coplanar;
    const bool below = height(points_[d]) < 0;
    const int second = below ? b : c, third = below ? c : b;
    // Outward normals: the fourth point lies behind the first face.
    add(0, second, third);
    add(second, 0, d);
    add(third, second, d);
    add(0, third, d);
    return HullDefect::none;
  }

  /// Replaces the faces that see the point strictly by a cone from their horizon. Faces in one plane with the
  /// point stay, so the visible ones are connected and no cone face is degenerate.
  void insert(int point) {
    edges_.clear();
    const auto hidden = std::partition(faces_.begin(), faces_.end(), [&](const Face& face) {
      return dot(face.normal, points_[point]) <= face.offset;
    });
    if (hidden == faces_.end()) return;
    for (auto face = hidden; face != faces_.end(); ++face) {
      for (int k = 0; k < 3; ++k) edges_.emplace_back(face->corner[k], face->corner[(k + 1) % 3]);
    }
    faces_.erase(hidden, faces_.end());
    std::sort(edges_.begin(), edges_.end());
    for (const auto& [from, to] : edges_) {
      if (!std::binary_search(edges_.begin(), edges_.end(), std::pair(to, from))) add(from, to, point);
    }
  }

  std::vector<GridPoint> points_;
  std::vector<Face> faces_;
  std::vector<std::pair<int, int>> edges_;
};

std::vector<GridPoint> snapped(const Points3d& points) {
  std::vector<GridPoint> result(static_cast<std::size_t>(points.cols()));
  if (points.cols() == 0) return result;
  const Vec3d low = points.rowwise().minCoeff();
  const double extent = (points.rowwise().maxCoeff() - low).maxCoeff();
  const double scale = extent > 0 ? kGrid / extent : 0;
  for (Index i = 0; i < points.cols(); ++i) {
    for (int k = 0; k < 3; ++k) {
      result[static_cast<std::size_t>(i)][k] = std::llround((points(k, i) - low[k]) * scale);
    }
  }
  return result;
}

double turn(const Points2d& p, int a, int b, int c) {
  return (p(0, b) - p(0, a)) * (p(1, c) - p(1, a)) - (p(1, b) - p(1, a)) * (p(0, c) - p(0, a));
}

}  // namespace

std::string_view describe(HullDefect defect) noexcept {
  switch (defect) {
    case HullDefect::none:
      return "";
    case HullDefect::too_few_points:
      return "fewer than four points";
    case HullDefect::coincident:
      return "all points coincide";
    case HullDefect::collinear:
      return "all points lie on one line";
    case HullDefect::coplanar:
      return "all points lie on one plane";
  }
  return "";
}

ConvexHull convex_hull(const Points3d& points) {
  if (!points.allFinite())
    throw Error(ErrorCode::internal, "a hull of points that are not finite was asked for");
  HullBuilder builder(snapped(points));
  ConvexHull hull;
  hull.defect = builder.build();
  if (hull.defect != HullDefect::none) return hull;
  const Vec3d origin = points.col(0);
  for (const Face& face : builder.faces()) {
    hull.faces.push_back(face.corner);
    const Vec3d a = points.col(face.corner[0]) - origin, b = points.col(face.corner[1]) - origin,
                c = points.col(face.corner[2]) - origin;
    hull.volume += a.dot(b.cross(c)) / 6;
    hull.area += (b - a).cross(c - a).norm() / 2;
  }
  return hull;
}

std::vector<int> convex_hull_2d(const Points2d& points) {
  std::vector<int> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::pair(points(0, i), points(1, i)); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  order.erase(std::unique(order.begin(), order.end(), [&](int a, int b) { return key(a) == key(b); }),
              order.end());
  if (order.size() < 3) return order;
  // Andrew's monotone chain: lower half from left to right, then the upper half back.
  std::vector<int> hull;
  const auto push = [&](int point, std::size_t least) {
    while (hull.size() >= least + 2 && turn(points, hull[hull.size() - 2], hull.back(), point) <= 0)
      hull.pop_back();
    hull.push_back(point);
  };
  for (const int point : order) push(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto point = order.rbegin() + 1; point != order.rend(); ++point) push(*point, lower);
  hull.pop_back();
  return hull;
}

double polygon_area(const Points2d& polygon) {
  double twice = 0;
  const Index count = polygon.cols();
  for (Index i = 0; i < count; ++i) {
    // Relative to the first corner, so that polygons far from the origin lose no digits.
    const Eigen::Vector2d a = polygon.col(i) - polygon.col(0),
                          b = polygon.col((i + 1) % count) - polygon.col(0);
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

double polygon_perimeter(const Points2d& polygon) {
  double sum = 0;
  for (Index i = 0; i < polygon.cols(); ++i) {
    sum += (polygon.col((i + 1) % polygon.cols()) - polygon.col(i)).norm();
  }
  return sum;
}

}  // namespace vitruvian
