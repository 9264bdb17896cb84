#include "measure/inside.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "geometry/mesh.h"

namespace vitruvian {
namespace {

constexpr float kDepth = 0.005f;
constexpr int kCells = 96;  // across the surface, each way

/// Rays run along z of a frame that no body's axis or edge lies along.
Eigen::Matrix3f ray_frame() {
  return Eigen::AngleAxisf(0.7f, Vec3f(0.36f, 0.48f, 0.8f).normalized()).toRotationMatrix();
}

/// Triangles by the cells of a grid across the rays.
class Grid {
 public:
  Grid(const Points3f& vertices, const Faces& faces)
      : low_(vertices.rowwise().minCoeff().head<2>()), cells_(kCells * kCells) {
    const Eigen::Vector2f extent = vertices.rowwise().maxCoeff().head<2>() - low_;
    scale_ = kCells / std::max(1e-6f, 1.0001f * extent.maxCoeff());
    for (Index f = 0; f < faces.cols(); ++f) {
      const Eigen::Vector2f a = vertices.col(faces(0, f)).head<2>(), b = vertices.col(faces(1, f)).head<2>(),
                            c = vertices.col(faces(2, f)).head<2>();
      const Eigen::Vector2i begin = cell(a.cwiseMin(b).cwiseMin(c)), end = cell(a.cwiseMax(b).cwiseMax(c));
      for (int y = begin.y(); y <= end.y(); ++y) {
        for (int x = begin.x(); x <= end.x(); ++x) cells_[y * kCells + x].push_back(static_cast<int>(f));
      }
    }
  }

  const std::vector<int>& at(const Vec3f& point) const {
    const Eigen::Vector2i place = cell(point.head<2>());
    return cells_[place.y() * kCells + place.x()];
  }

 private:
  Eigen::Vector2i cell(const Eigen::Vector2f& point) const {
    return ((point - low_) * scale_).cast<int>().cwiseMax(0).cwiseMin(kCells - 1);
  }

  Eigen::Vector2f low_;
  float scale_ = 1;
  std::vector<std::vector<int>> cells_;
};

double cross(const Vec3f& origin, const Vec3f& a, const Vec3f& b) {
  const Eigen::Vector2d p = (a - origin).head<2>().cast<double>(), q = (b - origin).head<2>().cast<double>();
  return p.x() * q.y() - p.y() * q.x();
}

/// How often the ray from `origin` leaves the surface more than it enters it: the winding number.
int winding(const Vec3f& origin, const Points3f& vertices, const Faces& faces, const Grid& grid) {
  int sum = 0;
  for (const int f : grid.at(origin)) {
    const Vec3f a = vertices.col(faces(0, f)), b = vertices.col(faces(1, f)), c = vertices.col(faces(2, f));
    const double u = cross(origin, b, c), v = cross(origin, c, a), w = cross(origin, a, b);
    const bool leaves = u > 0 && v > 0 && w > 0, enters = u < 0 && v < 0 && w < 0;
    if (!leaves && !enters) continue;
    const double height = (u * a.z() + v * b.z() + w * c.z()) / (u + v + w);
    if (height > origin.z()) sum += leaves ? 1 : -1;
  }
  return sum;
}

}  // namespace

double inside_share(const Points3f& vertices, const Points3f& normals, const Faces& faces) {
  if (vertices.cols() == 0 || faces.cols() == 0) return 0;
  const Eigen::Matrix3f turn = ray_frame();
  const Points3f turned = turn * vertices, moved = turn * (vertices + kDepth * normals);
  const Eigen::VectorXf area = vertex_areas(vertices, faces);
  const Grid grid(turned, faces);
  double all = 0, inside = 0;
  for (Index v = 0; v < moved.cols(); ++v) {
    all += area[v];
    if (winding(moved.col(v), turned, faces, grid) > 0) inside += area[v];
  }
  return all > 0 ? inside / all : 0;
}

}  // namespace vitruvian
