#include "geometry/mass_properties.h"

#include <Eigen/Geometry>
#include <cmath>

namespace vitruvian {

MassProperties mass_properties(const Points3d& vertices, const Faces& faces) {
  MassProperties result;
  if (faces.cols() == 0) return result;
  // Near the solid, so that the tetrahedra's large signed volumes do not cancel digits.
  Vec3d origin = Vec3d::Zero();
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) origin += vertices.col(faces(k, f));
  }
  origin /= 3.0 * static_cast<double>(faces.cols());
  Vec3d moment = Vec3d::Zero();
  Mat3d second = Mat3d::Zero();
  for (Index f = 0; f < faces.cols(); ++f) {
    const Vec3d a = vertices.col(faces(0, f)) - origin, b = vertices.col(faces(1, f)) - origin,
                c = vertices.col(faces(2, f)) - origin, sum = a + b + c;
    const double six_volumes = a.dot(b.cross(c));
    result.volume += six_volumes / 6;
    moment += six_volumes / 24 * sum;
    second += six_volumes / 120 *
              (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (std::abs(result.volume) < 1e-15) {
    result.volume = 0;
    result.centroid = origin;
    return result;
  }
  const Vec3d offset = moment / result.volume;
  second -= result.volume * offset * offset.transpose();
  result.centroid = origin + offset;
  result.inertia = second.trace() * Mat3d::Identity() - second;
  return result;
}

double surface_area(const Points3d& vertices, const Faces& faces) {
  double twice = 0;
  for (Index f = 0; f < faces.cols(); ++f) {
    const Vec3d a = vertices.col(faces(0, f)), b = vertices.col(faces(1, f)), c = vertices.col(faces(2, f));
    twice += (b - a).cross(c - a).norm();
  }
  return twice / 2;
}

}  // namespace vitruvian
