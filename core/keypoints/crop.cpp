#include "keypoints/crop.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

/// Beyond this shrinking factor the samples' own spacing skips pixels; no view is that large.
constexpr int kMaximumSamples = 16;

/// Adds the picture's value at a continuous pixel position to `sum`.
void add_sample(const View& view, float u, float v, std::array<float, 3>& sum) {
  const int width = view.camera.width, height = view.camera.height;
  const float x = u - 0.5f, y = v - 0.5f;
  if (!(x > -1.0f && y > -1.0f && x < static_cast<float>(width) && y < static_cast<float>(height))) {
    for (float& channel : sum) channel += kViewBackground;
    return;
  }
  const float floor_x = std::floor(x), floor_y = std::floor(y);
  const int column = static_cast<int>(floor_x), row = static_cast<int>(floor_y);
  const float right = x - floor_x, below = y - floor_y;
  const auto add_pixel = [&](int r, int c, float weight) {
    if (r < 0 || c < 0 || r >= height || c >= width) {
      for (float& channel : sum) channel += weight * kViewBackground;
      return;
    }
    const std::uint8_t* pixel = view.rgb.data() + 3 * (static_cast<std::size_t>(r) * width + c);
    for (int k = 0; k < 3; ++k) sum[k] += weight * static_cast<float>(pixel[k]);
  };
  add_pixel(row, column, (1 - below) * (1 - right));
  add_pixel(row, column + 1, (1 - below) * right);
  add_pixel(row + 1, column, below * (1 - right));
  add_pixel(row + 1, column + 1, below * right);
}

}  // namespace

Eigen::Vector2f Region::image_from_crop(const Eigen::Vector2f& crop, float crop_size) const {
  const Eigen::Vector2f d = (crop.array() - 0.5f * crop_size).matrix() * (size / crop_size);
  const float c = std::cos(rotation), s = std::sin(rotation);
  return centre + Eigen::Vector2f(c * d.x() - s * d.y(), s * d.x() + c * d.y());
}

Eigen::Vector2f Region::crop_from_image(const Eigen::Vector2f& image, float crop_size) const {
  const Eigen::Vector2f d = image - centre;
  const float c = std::cos(rotation), s = std::sin(rotation);
  const Eigen::Vector2f turned(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
  return (turned * (crop_size / size)).array() + 0.5f * crop_size;
}

std::vector<float> crop_tensor(const View& view, const Region& region, int crop_size, float low, float high) {
  if (!region.centre.allFinite() || !std::isfinite(region.rotation) || !std::isfinite(region.size) ||
      !(region.size > 0)) {
    throw Error(ErrorCode::internal, "crop_tensor: the region of interest is not finite or has no size");
  }
  const float pixels_per_step = region.size / static_cast<float>(crop_size);
  const int samples = static_cast<int>(std::ceil(std::clamp(pixels_per_step, 1.0f, float{kMaximumSamples})));
  const float spacing = 1.0f / static_cast<float>(samples);
  const float scale = (high - low) / 255.0f * spacing * spacing;

  const Eigen::Vector2f origin = region.image_from_crop({0, 0}, static_cast<float>(crop_size));
  const Eigen::Vector2f along_row =
      pixels_per_step * Eigen::Vector2f(std::cos(region.rotation), std::sin(region.rotation));
  const Eigen::Vector2f along_column(-along_row.y(), along_row.x());

  const std::size_t plane = static_cast<std::size_t>(crop_size) * crop_size;
  std::vector<float> tensor(3 * plane);
  for (int row = 0; row < crop_size; ++row) {
    for (int column = 0; column < crop_size; ++column) {
      std::array<float, 3> sum{};
      for (int j = 0; j < samples; ++j) {
        const float y = static_cast<float>(row) + (static_cast<float>(j) + 0.5f) * spacing;
        for (int i = 0; i < samples; ++i) {
          const float x = static_cast<float>(column) + (static_cast<float>(i) + 0.5f) * spacing;
          const Eigen::Vector2f position = origin + x * along_row + y * along_column;
          add_sample(view, position.x(), position.y(), sum);
        }
      }
      const std::size_t pixel = static_cast<std::size_t>(row) * crop_size + column;
      for (std::size_t k = 0; k < 3; ++k) tensor[k * plane + pixel] = low + scale * sum[k];
    }
  }
  return tensor;
}

}  // namespace vitruvian
