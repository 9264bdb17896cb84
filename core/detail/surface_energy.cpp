#include "detail/surface_energy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "geometry/mesh.h"

namespace vitruvian {
namespace {

// Cotangents of needles are bounded: a needle must neither push its corners apart nor glue them together.
constexpr double kLeastCotangent = 0.02, kMostCotangent = 10;
constexpr double kLeastArea = 1e-9;  // m^2

Eigen::SparseMatrix<double> cotangent_stiffness(const Points3f& vertices, const Faces& faces) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(12 * faces.cols() + vertices.cols()));
  // Every vertex has a diagonal entry, also one without a face.
  for (int v = 0; v < vertices.cols(); ++v) entries.emplace_back(v, v, 0);
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int at = faces(k, f), from = faces((k + 1) % 3, f), to = faces((k + 2) % 3, f);
      const Vec3d a = (vertices.col(from) - vertices.col(at)).cast<double>();
      const Vec3d b = (vertices.col(to) - vertices.col(at)).cast<double>();
      const double doubled_area = std::max(a.cross(b).norm(), kLeastArea);
      const double weight = 0.5 * std::clamp(a.dot(b) / doubled_area, kLeastCotangent, kMostCotangent);
      entries.emplace_back(from, to, -weight);
      entries.emplace_back(to, from, -weight);
      entries.emplace_back(from, from, weight);
      entries.emplace_back(to, to, weight);
    }
  }
  Eigen::SparseMatrix<double> stiffness(vertices.cols(), vertices.cols());
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

}  // namespace

SurfaceEnergy::SurfaceEnergy(const Points3f& vertices, const Faces& faces)
    : areas_(vertex_areas(vertices, faces).cast<double>().cwiseMax(kLeastArea)) {
  const Eigen::SparseMatrix<double> stiffness = cotangent_stiffness(vertices, faces);
  plate_ = stiffness * areas_.cwiseInverse().asDiagonal() * stiffness;
  // The membrane's entries on the plate's pattern: weighted sums of the two then never change it.
  membrane_ = stiffness + 0.0 * plate_;
}

Eigen::SparseMatrix<double> SurfaceEnergy::matrix(const Smoothness& smoothness) const {
  const double squared = smoothness.smoothing * smoothness.smoothing;
  const double membrane = squared / smoothness.bridging, spring = membrane / smoothness.fading;
  Eigen::SparseMatrix<double> sum = squared * squared * plate_ + membrane * membrane * membrane_;
  for (Index v = 0; v < sum.cols(); ++v) sum.coeffRef(v, v) += spring * spring * areas_[v];
  return sum;
}

}  // namespace vitruvian
