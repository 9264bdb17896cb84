#include "detail/vertex_offsets.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "detail/folds.h"
#include "detail/scan_pull.h"
#include "detail/surface_energy.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

constexpr double kFootShare = 0.5;
constexpr double kSearchedRound = 0.06;  // m round the fitted body
// Roughness that the model's coarse triangles alone bring about on a clean scan, m.
constexpr double kCleanRoughness = 0.0012;

/// `begin` .. `end`, geometric, by the share of the iterations done.
double annealed(double begin, double end, int iteration, int iterations) {
  if (iterations < 2) return end;
  return begin * std::pow(end / begin, static_cast<double>(iteration) / (iterations - 1));
}

/// Displacements against an energy: analysed once, factorised anew for each smoothness and set of weights.
class DisplacementSolver {
 public:
  DisplacementSolver(const Points3f& vertices, const Faces& faces) : energy_(vertices, faces) {}

  const Eigen::VectorXd& areas() const { return energy_.areas(); }

  /// Minimises  sum area weight |d - wanted|^2 + energy(d).
  Points3d solve(const Smoothness& smoothness, const Eigen::VectorXd& weight, const Points3d& wanted) {
    Eigen::SparseMatrix<double> matrix = energy_.matrix(smoothness);
    const Eigen::VectorXd data = weight.cwiseProduct(areas());
    for (Index v = 0; v < matrix.cols(); ++v) matrix.coeffRef(v, v) += data[v];
    if (!analysed_) factor_.analyzePattern(matrix);
    analysed_ = true;
    factor_.factorize(matrix);
    if (factor_.info() != Eigen::Success) {
      throw Error(ErrorCode::internal, "detail: the system of the vertex offsets is not positive definite");
    }
    const Eigen::MatrixX3d right = data.asDiagonal() * wanted.transpose();
    return factor_.solve(right).transpose();
  }

 private:
  SurfaceEnergy energy_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool analysed_ = false;
};

}  // namespace

Points3f vertex_offsets(const BodyModel& model, const BodyState& state, const ScanSurface& scan,
                        const DetailSettings& settings, const Execution& execution) {
  const Points3d parametric = posed_vertices<double>(model, state);
  const SurfaceSamples samples =
      sample_near(scan, parametric.cast<float>(), kSearchedRound, settings.scan_samples, settings.seed);
  DisplacementSolver solver(parametric.cast<float>(), model.faces);

  Points3d displacement = Points3d::Zero(3, parametric.cols());
  double noise = 0;  // m, standard deviation beyond what a clean scan shows
  for (int i = 0; i < settings.iterations; ++i) {
    execution.check();
    const auto level = [&](double begin, double end) { return annealed(begin, end, i, settings.iterations); };
    // A noisy scan is smoothed more, and its far points are not strays.
    const double smoothing =
        std::max(level(settings.smoothing_begin, settings.smoothing_end), std::min(2 * noise, 0.012));
    const double robust = std::max(level(settings.robust_begin, settings.robust_end), 3 * noise);
    const double reach = std::max(level(settings.reach_begin, settings.reach_end), 5 * noise);
    const double foot_share = kFootShare / (1 + std::pow(noise / kCleanRoughness, 2));

    const Points3f vertices = (parametric + displacement).cast<float>();
    const Points3f normals = vertex_normals(vertices, model.faces);
    // While the surface is stiff few samples tell as much as many.
    const int to_go = settings.iterations - 1 - i;
    const int stride = to_go < 2 ? 1 : to_go < 5 ? 2 : 4;
    const Pull pull = pull_of_scan(samples, scan, vertices, normals, model.faces, solver.areas(),
                                   {reach, robust, foot_share, stride}, execution);
    noise = std::sqrt(std::max(0.0, pull.roughness * pull.roughness - kCleanRoughness * kCleanRoughness));
    displacement = solver.solve({smoothing}, pull.weight, displacement + pull.displacement);
    execution.progress("detail", static_cast<double>(i + 1) / settings.iterations);
  }
  unfold(parametric, model.faces, displacement);
  return offsets_from_displacements(model, pose_skeleton(model, state), displacement);
}

}  // namespace vitruvian
