#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "keypoints/crop.h"
#include "keypoints/network.h"
#include "keypoints/view.h"

namespace vitruvian {

/// Before and after the BlazePose detector, as MediaPipe's pose detection graph does it.

/// Side of the detector's input, pixels.
constexpr int kDetectorSize = 224;

/// A body in a picture; everything in image pixels.
struct Detection {
  float score;  ///< 0..1
  /// Mid-hip; a point on the circle round the whole body, straight above the mid-hip along the trunk;
  /// mid-shoulder; a point on the circle round the upper body.
  std::array<Eigen::Vector2f, 4> keypoints;
  Eigen::Vector2f box_centre, box_size;  ///< of the head and shoulders
  float roll;  ///< radians in [-pi, pi]; how far the body's up is turned clockwise from the image's
};

/// Input tensor of Network::detector: the whole picture, letterboxed to a square.
std::vector<float> detector_input(const View& view);

/// All bodies with at least `minimum_score`, best first: anchors decoded, weighted non-maximum suppression at
/// an intersection over union of 0.3.
/// @param outputs  sizes as output_sizes(Network::detector).
std::vector<Detection> decode_detections(const NetworkOutputs& outputs, const View& view,
                                         float minimum_score = 0.5f);

/// The best of decode_detections, if any.
std::optional<Detection> decode_detection(const NetworkOutputs& outputs, const View& view,
                                          float minimum_score = 0.5f);

/// Centres of the detector's 2254 anchors, in units of the input's side.
std::vector<Eigen::Vector2f> detector_anchors();

}  // namespace vitruvian
