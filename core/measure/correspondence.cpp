#include "measure/correspondence.h"

#include <string>

#include "measure/free_point_tree.h"

namespace vitruvian {
namespace {

constexpr float kBoxShareOfHeight = 1.0f / 50.0f;
constexpr float kBoxGrowth = 1.5f;
constexpr int kBoxSearches = 5;

int nearest_free(const FreePointTree& tree, const Vec3f& vertex, float first_half_width) {
  float half_width = first_half_width;
  for (int search = 0; search < kBoxSearches; ++search, half_width *= kBoxGrowth) {
    const int found = tree.nearest(vertex, half_width);
    if (found >= 0) return found;
  }
  return tree.nearest(vertex);
}

}  // namespace

Rematching choose_rematching(Index template_vertices, Index scan_points) {
  return scan_points > kDenseRematchingThreshold && scan_points >= template_vertices ? Rematching::dense
                                                                                     : Rematching::sparse;
}

std::vector<int> match_sparse(const Points3f& template_vertices, const KdTree& scan_tree,
                              const Execution& execution) {
  std::vector<int> matches(static_cast<std::size_t>(template_vertices.cols()));
  execution.parallel_for(template_vertices.cols(), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      matches[v] = scan_tree.nearest(Vec3f(template_vertices.col(v))).index;
    }
  });
  return matches;
}

std::vector<int> match_dense(const Points3f& template_vertices, const Points3f& scan_points,
                             const Execution& execution) {
  std::vector<int> matches(static_cast<std::size_t>(template_vertices.cols()));
  if (matches.empty()) return matches;
  if (scan_points.cols() < template_vertices.cols()) {
    throw Error(ErrorCode::internal,
                "one-to-one matching needs at least as many scan points as template vertices");
  }
  const float height = template_vertices.row(1).maxCoeff() - template_vertices.row(1).minCoeff();
  const float half_width = height * kBoxShareOfHeight;
  FreePointTree tree(scan_points);
  for (std::size_t v = 0; v < matches.size(); ++v) {
    if (v % 512 == 0) execution.check();
    matches[v] = nearest_free(tree, template_vertices.col(static_cast<Index>(v)), half_width);
    if (matches[v] < 0) {
      throw Error(ErrorCode::internal, "template vertex " + std::to_string(v) + " is not finite");
    }
    tree.take(matches[v]);
  }
  return matches;
}

std::vector<int> rematch(const Points3f& template_vertices, const Points3f& scan_points,
                         const KdTree& scan_tree, const Execution& execution) {
  return choose_rematching(template_vertices.cols(), scan_points.cols()) == Rematching::dense
             ? match_dense(template_vertices, scan_points, execution)
             : match_sparse(template_vertices, scan_tree, execution);
}

}  // namespace vitruvian
