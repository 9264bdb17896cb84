#include "detail/folds.h"

#include <Eigen/Geometry>
#include <cstdint>

namespace vitruvian {
namespace {

constexpr int kSmoothingRounds = 12;
// A little further than needed, so that rounding to single precision folds nothing back.
constexpr double kSafeFacing = 0.02;

Vec3d normal_of(const Points3d& vertices, const Faces& faces, Index f) {
  const Vec3d a = vertices.col(faces(0, f));
  return (vertices.col(faces(1, f)) - a).cross(vertices.col(faces(2, f)) - a);
}

using Marks = std::vector<std::uint8_t>;  // V, 1: marked

Marks corners_of(const std::vector<int>& chosen, const Faces& faces, Index vertices) {
  Marks marks(static_cast<std::size_t>(vertices), 0);
  for (const int f : chosen) {
    for (int k = 0; k < 3; ++k) marks[faces(k, f)] = 1;
  }
  return marks;
}

/// Each marked vertex takes the mean of its neighbours', a neighbour counting once for each triangle shared.
Points3d averaged(const Points3d& displacement, const Faces& faces, const Marks& marks) {
  Points3d sum = Points3d::Zero(3, displacement.cols());
  std::vector<int> count(marks.size(), 0);
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int v = faces(k, f);
      if (marks[v] == 0) continue;
      sum.col(v) += displacement.col(faces((k + 1) % 3, f)) + displacement.col(faces((k + 2) % 3, f));
      count[v] += 2;
    }
  }
  Points3d result = displacement;
  for (std::size_t v = 0; v < marks.size(); ++v) {
    if (count[v] > 0) result.col(static_cast<Index>(v)) = sum.col(static_cast<Index>(v)) / count[v];
  }
  return result;
}

}  // namespace

std::vector<int> folded_faces(const Points3d& vertices, const Points3d& displacement, const Faces& faces,
                              double least_facing) {
  const Points3d moved = vertices + displacement;
  std::vector<int> folded;
  for (Index f = 0; f < faces.cols(); ++f) {
    const Vec3d before = normal_of(vertices, faces, f), after = normal_of(moved, faces, f);
    // A triangle without an area before cannot be told to have turned.
    if (before.norm() > 1e-12 && !(before.dot(after) > least_facing * before.norm() * after.norm())) {
      folded.push_back(static_cast<int>(f));
    }
  }
  return folded;
}

void unfold(const Points3d& vertices, const Faces& faces, Points3d& displacement) {
  const Index count = vertices.cols();
  Marks held(static_cast<std::size_t>(count), 0);
  for (int round = 0;; ++round) {
    const std::vector<int> folded = folded_faces(vertices, displacement, faces, kSafeFacing);
    if (folded.empty()) return;
    const Marks corners = corners_of(folded, faces, count);
    if (round < kSmoothingRounds) {
      // Smoothing round the fold, wider from round to round.
      Marks marks = corners;
      for (int ring = 0; ring < round / 3; ++ring) {
        Marks wider = marks;
        for (Index f = 0; f < faces.cols(); ++f) {
          if (marks[faces(0, f)] + marks[faces(1, f)] + marks[faces(2, f)] == 0) continue;
          for (int k = 0; k < 3; ++k) wider[faces(k, f)] = 1;
        }
        marks = std::move(wider);
      }
      displacement = averaged(displacement, faces, marks);
    } else {
      // What smoothing does not cure stays where it was before. Ends: each round holds more vertices, and a
      // triangle with all corners held is not folded.
      for (std::size_t v = 0; v < held.size(); ++v) {
        if (corners[v] != 0) held[v] = 1;
        if (held[v] != 0) displacement.col(static_cast<Index>(v)).setZero();
      }
    }
  }
}

}  // namespace vitruvian
