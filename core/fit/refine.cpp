#include "fit/refine.h"

#include <algorithm>
#include <cmath>

namespace vitruvian {
namespace {

constexpr float kSearchLimit = 0.06f;  // m; robust weights are negligible beyond
constexpr float kLeastNormalAgreement = 0.3f;

float weight_of(float squared, float agreement, float sigma) {
  if (agreement < kLeastNormalAgreement) return 0;
  const float g = sigma * sigma / (squared + sigma * sigma);
  return g * g;
}

/// Closest point and normal of the scan; weight 0 when there is none near.
struct Foot {
  Vec3f position, normal;
  bool found;
  int vertex = 0;  ///< of the scan, the nearest one
};

Foot foot_on_scan(const ScanSurface& surface, const Vec3f& x) {
  if (surface.mesh) {
    const SurfacePoint point = surface.mesh->query(x, kSearchLimit);
    if (point.face < 0) return {Vec3f::Zero(), Vec3f::Zero(), false};
    Vec3f normal = Vec3f::Zero();
    for (int k = 0; k < 3; ++k) {
      normal += point.barycentric[k] * surface.normals.col(surface.faces(k, point.face));
    }
    const float length = normal.norm();
    if (!(length > 1e-6f)) return {Vec3f::Zero(), Vec3f::Zero(), false};
    int corner;
    point.barycentric.maxCoeff(&corner);
    return {point.position, normal / length, true, surface.faces(corner, point.face)};
  }
  const Neighbour near = surface.tree.nearest(x);
  return {surface.points.col(near.index), surface.normals.col(near.index),
          near.squared_distance < kSearchLimit * kSearchLimit, near.index};
}

[[gnu::noinline]] void match_vertices(const FitModel& model, const PosedModel& posed,
                                      const ScanSurface& surface, const RegionLabels& regions, float sigma,
                                      float mean_area, std::vector<Correspondence>& matches,
                                      const Execution& execution) {
  matches.resize(model.body.vertex_count());
  execution.parallel_for(model.body.vertex_count(), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      const Vec3f x = posed.vertices.col(v);
      const Foot foot = foot_on_scan(surface, x);
      const Vec3f error = x - foot.position;
      const float area = std::clamp(model.body.vertex_area[v] / mean_area, 0.2f, 3.0f);
      const float weight =
          foot.found && regions.of_point(foot.vertex) == regions.of_vertex(v)
              ? area * weight_of(error.squaredNorm(), foot.normal.dot(posed.normals.col(v)), sigma)
              : 0;
      matches[v] = {static_cast<int>(v), weight, 0, foot.normal, error};
    }
  });
}

[[gnu::noinline]] void match_samples(const FitModel& model, const PosedModel& posed,
                                     const ScanTarget& samples, int count, float sigma,
                                     std::vector<Correspondence>& matches, const Execution& execution) {
  const ClosestPointOnMesh on_model(posed.vertices, model.body.faces);
  matches.resize(std::min<std::size_t>(count, samples.points.cols()));
  execution.parallel_for(
      static_cast<std::ptrdiff_t>(matches.size()), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Vec3f y = samples.points.col(i), normal = samples.normals.col(i);
          const SurfacePoint foot = on_model.query(y, kSearchLimit);
          if (foot.face < 0) {
            matches[i] = {0, 0, 0, normal, Vec3f::Zero()};
            continue;
          }
          // The row's derivative is taken at the triangle's dominant corner: a lever arm wrong by less than
          // an edge.
          int corner;
          foot.barycentric.maxCoeff(&corner);
          const int v = model.body.faces(corner, foot.face);
          const Vec3f error = foot.position - y;
          if (samples.regions.of_point(i) != samples.regions.of_vertex(v)) {
            matches[i] = {v, 0, 0, normal, error};
            continue;
          }
          matches[i] = {v, weight_of(error.squaredNorm(), normal.dot(posed.normals.col(v)), sigma), 0, normal,
                        error};
        }
      });
}

}  // namespace

void refine_fit(const FitModel& model, const ScanSurface& surface, const ScanTarget& samples,
                const RefineSettings& settings, BodyState& state, const Execution& execution,
                const RegionLabels& regions) {
  NormalEquations equations(model);
  PosedModel posed;
  std::vector<Correspondence> of_model, of_scan;
  const float mean_area = model.body.vertex_area.mean();
  for (int i = 0; i < settings.iterations; ++i) {
    execution.check();
    posed.update(model, state);
    const double progress = static_cast<double>(i) / std::max(1, settings.iterations - 1);
    const double sigma = settings.sigma_begin * std::pow(settings.sigma_end / settings.sigma_begin, progress);
    match_vertices(model, posed, surface, regions, static_cast<float>(sigma), mean_area, of_model, execution);
    match_samples(model, posed, samples, settings.scan_samples, static_cast<float>(sigma), of_scan,
                  execution);
    const BodyJacobian<float> jacobian(model.body, model.groups, state, posed.skeleton, posed.rest);
    equations.clear();
    const double unit = 1 / (sigma * sigma);
    equations.add(jacobian, of_model, unit / static_cast<double>(of_model.size()), execution);
    equations.add(jacobian, of_scan, unit / static_cast<double>(std::max<std::size_t>(1, of_scan.size())),
                  execution);
    equations.add_pose_prior(state, posed, settings.gaussian, settings.limits);
    equations.add_shape_prior(state, settings.shape);
    equations.step(posed, 1e-4, 0.2, state);
  }
}

}  // namespace vitruvian
