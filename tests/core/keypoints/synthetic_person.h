#pragma once

#include <span>
#include <utility>
#include <vector>

#include "keypoints/view.h"
#include "keypoints/views.h"

namespace vitruvian {

/// The 33 landmarks of a person who stands with hanging arms: body frame (Y up, facing +Z, left on +X),
/// metres.
inline std::vector<Vec3f> standing_person() {
  std::vector<Vec3f> at(kLandmarkCount);
  at[0] = {0, 0.62f, 0.12f};
  const auto pair = [&](int left, int right, float x, float y, float z) {
    at[left] = {x, y, z};
    at[right] = {-x, y, z};
  };
  pair(1, 4, 0.02f, 0.66f, 0.10f);
  pair(2, 5, 0.035f, 0.66f, 0.10f);
  pair(3, 6, 0.05f, 0.66f, 0.09f);
  pair(7, 8, 0.08f, 0.64f, 0.01f);
  pair(9, 10, 0.025f, 0.58f, 0.10f);
  pair(11, 12, 0.18f, 0.43f, 0);
  pair(13, 14, 0.24f, 0.15f, -0.02f);
  pair(15, 16, 0.27f, -0.10f, 0.03f);
  pair(17, 18, 0.29f, -0.18f, 0.03f);
  pair(19, 20, 0.28f, -0.19f, 0.06f);
  pair(21, 22, 0.25f, -0.15f, 0.07f);
  pair(23, 24, 0.10f, -0.08f, 0);
  pair(25, 26, 0.12f, -0.50f, 0.02f);
  pair(27, 28, 0.13f, -0.90f, -0.03f);
  pair(29, 30, 0.13f, -0.95f, -0.08f);
  pair(31, 32, 0.15f, -0.96f, 0.13f);
  return at;
}

/// The same with the left arm straight up.
inline std::vector<Vec3f> left_arm_raised() {
  std::vector<Vec3f> at = standing_person();
  at[13] = {0.24f, 0.70f, 0.02f};
  at[15] = {0.26f, 0.95f, 0.03f};
  at[17] = {0.28f, 1.03f, 0.03f};
  at[19] = {0.26f, 1.04f, 0.05f};
  at[21] = {0.22f, 1.00f, 0.05f};
  return at;
}

inline std::vector<Camera> ring_of(const std::vector<Vec3f>& landmarks, int count) {
  Points3f points(3, static_cast<Index>(landmarks.size()));
  for (std::size_t l = 0; l < landmarks.size(); ++l) points.col(static_cast<Index>(l)) = landmarks[l];
  return ring_cameras(points, count, Framing());
}

/// Perfect observations.
inline std::vector<ViewLandmarks> seen_by(std::span<const Camera> cameras,
                                          const std::vector<Vec3f>& landmarks) {
  std::vector<ViewLandmarks> views;
  for (const Camera& camera : cameras) {
    ViewLandmarks view;
    for (const Vec3f& landmark : landmarks) view.landmarks.push_back({camera.project(landmark), 1.0f, 1.0f});
    view.body_presence = 1;
    views.push_back(view);
  }
  return views;
}

/// Exchanges left and right of the legs (0), arms (1) or torso and face (2) in one view.
inline void exchange_group(ViewLandmarks& view, int group) {
  const std::vector<std::pair<int, int>> pairs[] = {
      {{25, 26}, {27, 28}, {29, 30}, {31, 32}},
      {{13, 14}, {15, 16}, {17, 18}, {19, 20}, {21, 22}},
      {{11, 12}, {23, 24}, {7, 8}, {1, 4}, {2, 5}, {3, 6}, {9, 10}}};
  for (const auto& [left, right] : pairs[group]) std::swap(view.landmarks[left], view.landmarks[right]);
}

/// Landmarks of full confidence at the given places.
inline std::vector<Landmark3d> certain(const std::vector<Vec3f>& positions) {
  std::vector<Landmark3d> landmarks;
  for (const Vec3f& position : positions) landmarks.push_back({position, 1.0f, 0.0f});
  return landmarks;
}

}  // namespace vitruvian
