#pragma once

#include <Eigen/Core>
#include <vector>

#include "keypoints/view.h"

namespace vitruvian {

/// A square part of an image, possibly turned, that a network looks at. Coordinates are continuous pixels:
/// (0, 0) is the upper left corner of the upper left pixel, whose centre is (0.5, 0.5).
struct Region {
  Eigen::Vector2f centre;  ///< image pixels
  float size;              ///< side in image pixels, > 0
  float rotation;          ///< radians; the crop's upward direction, turned clockwise from the image's

  /// Image point of a point of the crop, whose side is `crop_size` crop pixels.
  Eigen::Vector2f image_from_crop(const Eigen::Vector2f& crop, float crop_size) const;
  /// Inverse of image_from_crop.
  Eigen::Vector2f crop_from_image(const Eigen::Vector2f& image, float crop_size) const;
};

/// Grey value of a view's background; crops are filled with it outside the image.
constexpr float kViewBackground = 190.0f;

/// The part `region` of a view's picture as a network's input tensor: 3 x crop_size x crop_size, channels
/// first, RGB bytes 0..255 mapped linearly to [low, high]. Bilinear; when the crop shrinks the image, each
/// value is the mean of n x n bilinear samples spread over the crop's pixel, n = the shrinking factor rounded
/// up, so that nothing is skipped.
/// @throws Error(internal) when the region is not finite or has no size.
std::vector<float> crop_tensor(const View& view, const Region& region, int crop_size, float low, float high);

}  // namespace vitruvian
