#pragma once

#include <vector>

#include "keypoints/crop.h"
#include "keypoints/network.h"
#include "keypoints/view.h"

namespace vitruvian {

/// Before and after the BlazePose landmark network, as MediaPipe's pose graphs do it (Bazarevsky et al. 2020,
/// "BlazePose: On-device Real-time Body Pose Tracking").

/// Side of the landmark network's crop, pixels.
constexpr int kLandmarkCropSize = 256;

/// The square round a view's silhouette, 1.25 times the larger side of its bounding box, upright. The whole
/// image when the silhouette is empty.
Region region_from_silhouette(const View& view);

/// Input tensor of Network::landmarks for one region of a view.
std::vector<float> landmarks_input(const View& view, const Region& region);

/// What one run of the landmark network says.
struct LandmarkReading {
  ViewLandmarks view;       ///< 33 landmarks in image pixels
  Eigen::Vector2f mid_hip;  ///< auxiliary point 33, image pixels
  Eigen::Vector2f
      circle_point;  ///< auxiliary point 34: above mid_hip on the circle round the whole body, image pixels
};

/// Decodes the outputs of Network::landmarks for the crop `region`. Where a landmark's heatmap is sure (some
/// probability of 0.5 or more in the 7 x 7 cells round the regressed point), the point is the heatmap's
/// centroid there; else it stays as regressed (MediaPipe's RefineLandmarksFromHeatmap; it halves the error).
/// @param outputs  sizes as output_sizes(Network::landmarks).
LandmarkReading decode_landmarks(const NetworkOutputs& outputs, const Region& region);

/// The region that holds the body with `circle_point` straight above `mid_hip`: centre mid_hip, size 2.5
/// times their distance.
Region region_from_auxiliary(const Eigen::Vector2f& mid_hip, const Eigen::Vector2f& circle_point);

/// Whether a second look at `next` can be trusted: its centre lies in the image and its size is 0.4 to 2.5
/// times that of `first`.
bool is_plausible_region(const Region& next, const Region& first, const View& view);

}  // namespace vitruvian
