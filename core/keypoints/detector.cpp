#include "keypoints/detector.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace vitruvian {
namespace {

constexpr int kValuesPerAnchor = 12;
constexpr float kSuppressionOverlap = 0.3f;

/// The picture's centred square that the detector sees.
Region letterbox(const View& view) {
  const float width = static_cast<float>(view.camera.width), height = static_cast<float>(view.camera.height);
  return {{0.5f * width, 0.5f * height}, std::max(width, height), 0.0f};
}

/// One anchor's answer, in units of the input's side.
struct Candidate {
  float score;
  std::array<float, kValuesPerAnchor> values;  // box centre, box size, four keypoints
};

float intersection_over_union(const Candidate& a, const Candidate& b) {
  float intersection = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const float low =
        std::max(a.values[axis] - 0.5f * a.values[2 + axis], b.values[axis] - 0.5f * b.values[2 + axis]);
    const float high =
        std::min(a.values[axis] + 0.5f * a.values[2 + axis], b.values[axis] + 0.5f * b.values[2 + axis]);
    intersection *= std::max(0.0f, high - low);
  }
  const float both = a.values[2] * a.values[3] + b.values[2] * b.values[3] - intersection;
  return both > 0 ? intersection / both : 0.0f;
}

/// Candidates with at least `minimum_score`, best first (equal scores in anchor order).
std::vector<Candidate> candidates_of(const NetworkOutputs& outputs, float minimum_score) {
  const std::span<const float> boxes = outputs[0], logits = outputs[1];
  const std::vector<Eigen::Vector2f> anchors = detector_anchors();
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    const float score = 1.0f / (1.0f + std::exp(-std::clamp(logits[k], -100.0f, 100.0f)));
    if (!(score >= minimum_score)) continue;
    Candidate candidate{score, {}};
    for (std::size_t v = 0; v < kValuesPerAnchor; ++v) {
      const bool is_size = v == 2 || v == 3;
      candidate.values[v] =
          boxes[k * kValuesPerAnchor + v] / kDetectorSize + (is_size ? 0.0f : anchors[k][v % 2]);
    }
    candidates.push_back(candidate);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  return candidates;
}

Detection detection_of(const Candidate& candidate, const Region& region) {
  const auto image_point = [&](std::size_t first) {
    return region.image_from_crop({candidate.values[first], candidate.values[first + 1]}, 1.0f);
  };
  Detection detection;
  detection.score = candidate.score;
  for (std::size_t k = 0; k < 4; ++k) detection.keypoints[k] = image_point(4 + 2 * k);
  detection.box_centre = image_point(0);
  detection.box_size = Eigen::Vector2f(candidate.values[2], candidate.values[3]) * region.size;
  const Eigen::Vector2f up = detection.keypoints[1] - detection.keypoints[0];
  detection.roll = std::atan2(up.x(), -up.y());
  return detection;
}

}  // namespace

std::vector<Eigen::Vector2f> detector_anchors() {
  std::vector<Eigen::Vector2f> anchors;
  anchors.reserve(2254);
  struct Layer {
    int cells, anchors_per_cell;
  };
  for (const Layer& layer : {Layer{28, 2}, Layer{14, 2}, Layer{7, 6}}) {
    const float side = 1.0f / static_cast<float>(layer.cells);
    for (int y = 0; y < layer.cells; ++y) {
      for (int x = 0; x < layer.cells; ++x) {
        const Eigen::Vector2f centre((static_cast<float>(x) + 0.5f) * side,
                                     (static_cast<float>(y) + 0.5f) * side);
        anchors.insert(anchors.end(), static_cast<std::size_t>(layer.anchors_per_cell), centre);
      }
    }
  }
  return anchors;
}

std::vector<float> detector_input(const View& view) {
  return crop_tensor(view, letterbox(view), kDetectorSize, -1.0f, 1.0f);
}

std::vector<Detection> decode_detections(const NetworkOutputs& outputs, const View& view,
                                         float minimum_score) {
  std::vector<Candidate> remaining = candidates_of(outputs, minimum_score);
  std::vector<Detection> detections;
  while (!remaining.empty()) {
    const Candidate best = remaining.front();
    Candidate mean{best.score, {}};
    float total = 0;
    std::vector<Candidate> others;
    for (std::size_t k = 0; k < remaining.size(); ++k) {
      const Candidate& candidate = remaining[k];
      // The best one always belongs to its own group, also when its box is degenerate.
      if (k > 0 && !(intersection_over_union(best, candidate) > kSuppressionOverlap)) {
        others.push_back(candidate);
        continue;
      }
      total += candidate.score;
      for (std::size_t v = 0; v < kValuesPerAnchor; ++v)
        mean.values[v] += candidate.score * candidate.values[v];
    }
    for (float& value : mean.values) value /= total;
    detections.push_back(detection_of(mean, letterbox(view)));
    remaining = std::move(others);
  }
  return detections;
}

std::optional<Detection> decode_detection(const NetworkOutputs& outputs, const View& view,
                                          float minimum_score) {
  const std::vector<Detection> detections = decode_detections(outputs, view, minimum_score);
  if (detections.empty()) return std::nullopt;
  return detections.front();
}

}  // namespace vitruvian
