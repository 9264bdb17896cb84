#pragma once

#include <Eigen/SparseCore>

#include "base/types.h"

namespace vitruvian {

/// Lengths that say how smooth a displacement field is to be, metres.
struct Smoothness {
  double smoothing;        ///< details shorter than about 2 pi times this are smoothed away
  double bridging = 0.05;  ///< gaps longer than this are bridged like a membrane, shorter ones like a plate
  double fading = 0.15;    ///< this far from all observations the displacement fades to nothing
};

/// Quadratic energy of displacements d of a triangle mesh's vertices, the sum of a thin plate, a membrane and
/// a spring, as integrals over the surface:
///
///   E(d) = s^4 |laplace d|^2 + m^2 |grad d|^2 + e |d|^2,   m = s^2 / bridging, e = (m / fading)^2
///
/// (Botsch and Sorkine 2008, "On linear variational surface deformation methods", section 3.2), with
/// cotangent weights and lumped areas. Lengths are physical, so that fine and coarse parts of a mesh are
/// smoothed alike.
class SurfaceEnergy {
 public:
  /// @param vertices  3 x V, metres. Vertices without a face have only the spring.
  SurfaceEnergy(const Points3f& vertices, const Faces& faces);

  const Eigen::VectorXd& areas() const { return areas_; }  ///< V, m^2, positive

  /// Symmetric V x V matrix of the energy (each coordinate by itself). Its pattern is always the same.
  Eigen::SparseMatrix<double> matrix(const Smoothness& smoothness) const;

 private:
  Eigen::VectorXd areas_;
  Eigen::SparseMatrix<double> membrane_, plate_;  // on the plate's pattern
};

}  // namespace vitruvian
