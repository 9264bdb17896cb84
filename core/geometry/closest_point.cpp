#include "geometry/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vitruvian {
namespace {

constexpr int kLeafTriangles = 6;

// Squared sine of a triangle's first angle below which rounding decides in which region of it a point seems
// to lie; and the like for points that are far away for the triangle's size.
constexpr float kNeedle = 1e-4f;
constexpr float kUnsure = 1e-5f;

/// Best of a triangle's edges and of `inner`, where that lies inside, as barycentric weights.
Vec3f best_of_edges(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& inner) {
  const Vec3f* corners[3] = {&a, &b, &c};
  Vec3f best = inner;
  float best_squared = inner.minCoeff() >= 0 ? (inner[0] * a + inner[1] * b + inner[2] * c - p).squaredNorm()
                                             : std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3f &from = *corners[k], edge = *corners[(k + 1) % 3] - from;
    const float squared_length = edge.squaredNorm();
    const float t = squared_length > 0 ? std::clamp(edge.dot(p - from) / squared_length, 0.0f, 1.0f) : 0;
    const float squared = (from + t * edge - p).squaredNorm();
    if (!(squared >= best_squared)) {
      best_squared = squared;
      best.setZero();
      best[k] = 1 - t;
      best[(k + 1) % 3] = t;
    }
  }
  return best;
}

/// Closest point of a triangle as barycentric weights (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3f closest_barycentric(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a;
  const Vec3f normal = ab.cross(ac);
  const float squared_size = ab.squaredNorm() * ac.squaredNorm(), squared_normal = normal.squaredNorm();
  if (!(squared_normal > kNeedle * squared_size)) {
    const float v = ap.cross(ac).dot(normal) / squared_normal, w = ab.cross(ap).dot(normal) / squared_normal;
    return best_of_edges(p, a, b, c, {1 - v - w, v, w});
  }
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3f bp = p - b;
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const float v = d1 - d3 > 0 ? d1 / (d1 - d3) : 0;
    return {1 - v, v, 0};
  }
  const Vec3f cp = p - c;
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const float w = d2 - d6 > 0 ? d2 / (d2 - d6) : 0;
    return {1 - w, 0, w};
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float sum = (d4 - d3) + (d5 - d6);
    const float w = sum > 0 ? (d4 - d3) / sum : 0;
    return {0, 1 - w, w};
  }
  const float total = va + vb + vc;  // squared length of the normal
  const float v = vb / total, w = vc / total;
  const Vec3f inner(1 - v - w, v, w);
  const float reach = std::max({ap.squaredNorm(), bp.squaredNorm(), cp.squaredNorm()});
  const bool sure = total > kUnsure * std::sqrt(squared_size) * reach;
  return sure && inner.minCoeff() >= 0 ? inner : best_of_edges(p, a, b, c, inner);
}

}  // namespace

struct ClosestPointOnMesh::Hierarchy {
  struct Node {
    Vec3f low, high;
    int first =
        0;  ///< leaf: first triangle in `order`; inner: index of the second child (the first follows at once)
    int count = 0;  ///< leaf: number of triangles; inner: 0
  };
  std::vector<Node> nodes;
  std::vector<int> order;                     ///< face index by position
  std::vector<std::array<Vec3f, 3>> corners;  ///< by position in `order`

  static float squared_distance(const Node& node, const Vec3f& p) {
    return (node.low - p).cwiseMax(p - node.high).cwiseMax(0.0f).squaredNorm();
  }

  void build(const Points3f& vertices, const Faces& faces, const std::vector<Vec3f>& centres, int begin,
             int end) {
    const int index = static_cast<int>(nodes.size());
    nodes.emplace_back();
    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::max()), high = -low, centre_low = low,
          centre_high = high;
    for (int i = begin; i < end; ++i) {
      for (int k = 0; k < 3; ++k) {
        low = low.cwiseMin(vertices.col(faces(k, order[i])));
        high = high.cwiseMax(vertices.col(faces(k, order[i])));
      }
      centre_low = centre_low.cwiseMin(centres[order[i]]);
      centre_high = centre_high.cwiseMax(centres[order[i]]);
    }
    nodes[index].low = low;
    nodes[index].high = high;
    if (end - begin <= kLeafTriangles) {
      nodes[index].first = begin;
      nodes[index].count = end - begin;
      return;
    }
    int axis;
    (centre_high - centre_low).maxCoeff(&axis);
    const int middle = (begin + end) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
      return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
    });
    build(vertices, faces, centres, begin, middle);
    nodes[index].first = static_cast<int>(nodes.size());
    build(vertices, faces, centres, middle, end);
  }
};

ClosestPointOnMesh::ClosestPointOnMesh(const Points3f& vertices, const Faces& faces)
    : hierarchy_(std::make_unique<Hierarchy>()) {
  const int count = static_cast<int>(faces.cols());
  Hierarchy& h = *hierarchy_;
  h.order.resize(count);
  std::vector<Vec3f> centres(count);
  for (int f = 0; f < count; ++f) {
    h.order[f] = f;
    centres[f] = (vertices.col(faces(0, f)) + vertices.col(faces(1, f)) + vertices.col(faces(2, f))) / 3;
  }
  if (count == 0) return;
  h.nodes.reserve(static_cast<std::size_t>(count));
  h.build(vertices, faces, centres, 0, count);
  h.corners.resize(count);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) h.corners[i][k] = vertices.col(faces(k, h.order[i]));
  }
}

ClosestPointOnMesh::ClosestPointOnMesh(ClosestPointOnMesh&&) noexcept = default;
ClosestPointOnMesh& ClosestPointOnMesh::operator=(ClosestPointOnMesh&&) noexcept = default;
ClosestPointOnMesh::~ClosestPointOnMesh() = default;

SurfacePoint ClosestPointOnMesh::query(const Vec3f& point, float limit) const {
  const Hierarchy& h = *hierarchy_;
  SurfacePoint best;
  best.distance = limit;
  if (h.nodes.empty()) return best;
  float best_squared = limit < 1e18f ? limit * limit : std::numeric_limits<float>::max();
  struct Waiting {
    int node;
    float squared;
  };
  std::array<Waiting, 128> stack;
  int depth = 0;
  stack[depth++] = {0, Hierarchy::squared_distance(h.nodes[0], point)};
  while (depth > 0) {
    const Waiting top = stack[--depth];
    if (top.squared >= best_squared) continue;
    const Hierarchy::Node& node = h.nodes[top.node];
    if (node.count > 0) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        const auto& [a, b, c] = h.corners[i];
        const Vec3f weights = closest_barycentric(point, a, b, c);
        const Vec3f position = weights[0] * a + weights[1] * b + weights[2] * c;
        const float squared = (position - point).squaredNorm();
        if (squared < best_squared) {
          best_squared = squared;
          best = {h.order[i], position, weights, std::sqrt(squared)};
        }
      }
      continue;
    }
    const int left = top.node + 1, right = node.first;
    const float to_left = Hierarchy::squared_distance(h.nodes[left], point);
    const float to_right = Hierarchy::squared_distance(h.nodes[right], point);
    if (to_left < to_right) {
      stack[depth++] = {right, to_right};
      stack[depth++] = {left, to_left};
    } else {
      stack[depth++] = {left, to_left};
      stack[depth++] = {right, to_right};
    }
  }
  return best;
}

}  // namespace vitruvian
