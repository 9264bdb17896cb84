#pragma once

#include <functional>
#include <span>

#include "body/parameter_gradient.h"
#include "fit/chamfer.h"

namespace vitruvian {

/// How the paper's objectives are minimised (section 4; "Acceleration settings" (b)): Adam first, L-BFGS for
/// the rest. The defaults are the published ones; the published CPU configuration is 100 of 2000.
struct PaperSolverOptions {
  int iterations = 6000;       ///< of each stage
  int adam_iterations = 6000;  ///< of these; the rest is L-BFGS
  double adam_step = 0.005;
};

/// Weights of section 3.2.
struct ChamferFitOptions {
  ChamferOptions distance;
  double shape_weight = 0.001;  ///< lambda_beta
  double pose_weight = 0.001;   ///< lambda_theta
};

struct PaperFit {
  BodyState state;
  double initial_energy = 0;
  double energy = 0;
  int adam_iterations = 0;
  int lbfgs_iterations = 0;  ///< fewer than asked for when no step decreases the energy any more
};

/// Called after every iteration with its number (from 1) and the energy before it.
using EnergyCallback = std::function<void(int iteration, double energy)>;

/// Distance minimisation (paper, section 3.2): from (beta_0, theta_0), minimises over shape, pose with root,
/// and translation
///   Chamfer(M(beta, theta), S) + lambda_beta |beta - beta_0|^2 + lambda_theta |theta - theta_0|^2,
/// theta being all axis-angle numbers, the root's included.
PaperFit fit_chamfer(const BodyModel& model, int betas, const ChamferDistance& distance,
                     const BodyState& start, const ChamferFitOptions& weights,
                     const PaperSolverOptions& solver, const Execution& execution,
                     const EnergyCallback& each = {});

/// Final parameter fitting (paper, section 3.3.2): minimises
///   E_vtx = 1/(3N) sum_j |v_j(beta, theta) - p_j|^2
/// over the same unknowns, without regularisers.
/// @param scan     3 x M, body frame.
/// @param matches  N, column of `scan` of each template vertex.
PaperFit fit_correspondences(const BodyModel& model, int betas, const Points3f& scan,
                             std::span<const int> matches, const BodyState& start,
                             const PaperSolverOptions& solver, const Execution& execution,
                             const EnergyCallback& each = {});

}  // namespace vitruvian
