#include "keypoints/blazepose.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace vitruvian {
namespace {

constexpr float kRegionMargin = 1.25f;
constexpr int kPointCount = 39;  // 33 landmarks, then 6 auxiliary points
constexpr int kValuesPerPoint = 5;
constexpr int kHeatmapSize = 64;
constexpr int kRefinementRadius = 3;
constexpr float kRefinementConfidence = 0.5f;

float sigmoid(float logit) { return 1.0f / (1.0f + std::exp(-logit)); }

/// A point in crop pixels moved to the centroid of its heatmap (64 x 64 logits) nearby, if that is sure.
/// Cells count from their index, without a half, as the network was trained.
Eigen::Vector2f refine(const Eigen::Vector2f& point, std::span<const float> heatmap) {
  const float cells_per_pixel = static_cast<float>(kHeatmapSize) / kLandmarkCropSize;
  const Eigen::Vector2f cell = point * cells_per_pixel;
  if (!(cell.x() > -1 && cell.y() > -1 && cell.x() < kHeatmapSize && cell.y() < kHeatmapSize)) return point;
  const int column = static_cast<int>(cell.x()), row = static_cast<int>(cell.y());
  float total = 0, highest = 0;
  Eigen::Vector2f weighted = Eigen::Vector2f::Zero();
  for (int r = std::max(0, row - kRefinementRadius); r <= std::min(kHeatmapSize - 1, row + kRefinementRadius);
       ++r) {
    for (int c = std::max(0, column - kRefinementRadius);
         c <= std::min(kHeatmapSize - 1, column + kRefinementRadius); ++c) {
      const float probability = sigmoid(heatmap[static_cast<std::size_t>(r) * kHeatmapSize + c]);
      total += probability;
      highest = std::max(highest, probability);
      weighted += probability * Eigen::Vector2f(static_cast<float>(c), static_cast<float>(r));
    }
  }
  if (highest < kRefinementConfidence) return point;
  return weighted / (total * cells_per_pixel);
}

}  // namespace

Region region_from_silhouette(const View& view) {
  const float width = static_cast<float>(view.right - view.left),
              height = static_cast<float>(view.bottom - view.top);
  if (!(width > 0 && height > 0)) {
    const float w = static_cast<float>(view.camera.width), h = static_cast<float>(view.camera.height);
    return {{0.5f * w, 0.5f * h}, std::max(w, h), 0.0f};
  }
  const Eigen::Vector2f centre(0.5f * static_cast<float>(view.left + view.right),
                               0.5f * static_cast<float>(view.top + view.bottom));
  return {centre, kRegionMargin * std::max(width, height), 0.0f};
}

std::vector<float> landmarks_input(const View& view, const Region& region) {
  return crop_tensor(view, region, kLandmarkCropSize, 0.0f, 1.0f);
}

LandmarkReading decode_landmarks(const NetworkOutputs& outputs, const Region& region) {
  const std::span<const float> points = outputs[0], heatmaps = outputs[2];
  const std::size_t cells = static_cast<std::size_t>(kHeatmapSize) * kHeatmapSize;
  LandmarkReading reading;
  reading.view.body_presence = outputs[1][0];
  reading.view.landmarks.reserve(kLandmarkCount);
  for (int k = 0; k < kLandmarkCount + 2; ++k) {
    static_assert(kLandmarkCount + 2 <= kPointCount);
    const std::span<const float> values =
        points.subspan(static_cast<std::size_t>(k) * kValuesPerPoint, kValuesPerPoint);
    const Eigen::Vector2f crop = refine({values[0], values[1]}, heatmaps.subspan(k * cells, cells));
    const Eigen::Vector2f pixel = region.image_from_crop(crop, kLandmarkCropSize);
    if (k < kLandmarkCount) {
      reading.view.landmarks.push_back({pixel, sigmoid(values[3]), sigmoid(values[4])});
    } else if (k == kLandmarkCount) {
      reading.mid_hip = pixel;
    } else {
      reading.circle_point = pixel;
    }
  }
  return reading;
}

Region region_from_auxiliary(const Eigen::Vector2f& mid_hip, const Eigen::Vector2f& circle_point) {
  const Eigen::Vector2f up = circle_point - mid_hip;
  return {mid_hip, 2 * kRegionMargin * up.norm(), std::atan2(up.x(), -up.y())};
}

bool is_plausible_region(const Region& next, const Region& first, const View& view) {
  const bool inside = next.centre.x() >= 0 && next.centre.y() >= 0 &&
                      next.centre.x() <= static_cast<float>(view.camera.width) &&
                      next.centre.y() <= static_cast<float>(view.camera.height);
  return inside && std::isfinite(next.rotation) && next.size >= 0.4f * first.size &&
         next.size <= 2.5f * first.size;
}

}  // namespace vitruvian
