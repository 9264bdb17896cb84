#pragma once

#include <string_view>
#include <vector>

#include "anthropometry/figure.h"

namespace vitruvian {

/// A point on the template's surface that follows every shape and pose.
struct SurfaceLandmark {
  std::string_view name;
  std::array<int, 3> vertex{};
  Vec3d weight = Vec3d::Zero();  ///< of the three vertices, sums to 1
  int segment = 0;               ///< of the vertex that weighs most

  Vec3d position(const Points3d& vertices) const {
    return weight[0] * vertices.col(vertex[0]) + weight[1] * vertices.col(vertex[1]) +
           weight[2] * vertices.col(vertex[2]);
  }
};

/// The anatomical landmarks (landmark_table.h) on a model's template. They were placed on the default body;
/// to any other model of the family they are carried over: each is moved with the bone it lies at, stretched
/// by the ratio of the bones' lengths along it and of the statures across it, and then put on the closest
/// point of the template.
class LandmarkSet {
 public:
  explicit LandmarkSet(const MeasuredModel& model);

  const std::vector<SurfaceLandmark>& all() const { return landmarks_; }
  /// @throws Error(internal) when there is none of that name.
  const SurfaceLandmark& named(std::string_view name) const;

 private:
  std::vector<SurfaceLandmark> landmarks_;
};

}  // namespace vitruvian
