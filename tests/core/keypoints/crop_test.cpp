#include "keypoints/crop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

View make_view(int width, int height) {
  View view{};
  view.camera.width = width;
  view.camera.height = height;
  view.rgb.assign(static_cast<std::size_t>(3) * width * height, 190);
  return view;
}

View random_view(int width, int height, Random& random) {
  View view = make_view(width, height);
  for (std::uint8_t& value : view.rgb) value = static_cast<std::uint8_t>(random.below(256));
  return view;
}

/// Value of the picture extended by the background, bilinear in double precision.
double sample(const View& view, double u, double v, int channel) {
  const double x = u - 0.5, y = v - 0.5;
  double sum = 0;
  for (int r = static_cast<int>(std::floor(y)); r <= std::floor(y) + 1; ++r) {
    for (int c = static_cast<int>(std::floor(x)); c <= std::floor(x) + 1; ++c) {
      const bool inside = r >= 0 && c >= 0 && r < view.camera.height && c < view.camera.width;
      const double value =
          inside ? view.rgb[3 * (static_cast<std::size_t>(r) * view.camera.width + c) + channel] : 190;
      sum += value * (1 - std::abs(x - c)) * (1 - std::abs(y - r));
    }
  }
  return sum;
}

TEST(Region, CropAndImageAreInverse) {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const Region region{
        {static_cast<float>(random.uniform(-50, 450)), static_cast<float>(random.uniform(-50, 450))},
        static_cast<float>(random.uniform(10, 900)),
        static_cast<float>(random.uniform(-7, 7))};
    const Eigen::Vector2f crop(static_cast<float>(random.uniform(0, 256)),
                               static_cast<float>(random.uniform(0, 256)));
    const Eigen::Vector2f back = region.crop_from_image(region.image_from_crop(crop, 256), 256);
    EXPECT_LT((back - crop).norm(), 2e-2f * 256 / region.size + 1e-3f) << "seed 7, trial " << trial;
  }
}

TEST(Region, RotationTurnsUpClockwise) {
  const Region region{{100, 100}, 50, static_cast<float>(std::numbers::pi / 2)};
  // Straight up in the crop is to the right in the image.
  EXPECT_LT((region.image_from_crop({128, 0}, 256) - Eigen::Vector2f(125, 100)).norm(), 1e-3f);
}

TEST(CropTensor, WholeImageAtItsOwnSizeIsTheImage) {
  Random random(1);
  const View view = random_view(32, 32, random);
  const std::vector<float> tensor = crop_tensor(view, {{16, 16}, 32, 0}, 32, 0, 1);
  ASSERT_EQ(tensor.size(), 3u * 32 * 32);
  for (int k = 0; k < 3; ++k) {
    for (int p = 0; p < 32 * 32; ++p) {
      EXPECT_NEAR(tensor[static_cast<std::size_t>(k * 32 * 32 + p)],
                  view.rgb[static_cast<std::size_t>(3 * p + k)] / 255.0, 1e-6);
    }
  }
}

TEST(CropTensor, MatchesBruteForceBilinearWhenMagnifying) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const View view = random_view(40, 56, random);
    const Region region{
        {static_cast<float>(random.uniform(-5, 45)), static_cast<float>(random.uniform(-5, 60))},
        static_cast<float>(random.uniform(5, 24)),
        static_cast<float>(random.uniform(-4, 4))};
    const std::vector<float> tensor = crop_tensor(view, region, 24, -1, 1);
    for (int row = 0; row < 24; ++row) {
      for (int column = 0; column < 24; ++column) {
        const Eigen::Vector2f p =
            region.image_from_crop({static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f}, 24);
        for (int k = 0; k < 3; ++k) {
          const double expected = -1 + 2 * sample(view, p.x(), p.y(), k) / 255;
          EXPECT_NEAR(tensor[static_cast<std::size_t>((k * 24 + row) * 24 + column)], expected, 1e-4)
              << "seed " << seed;
        }
      }
    }
  }
}

TEST(CropTensor, ShrinkingByAWholeNumberIsTheMeanOfTheBlock) {
  Random random(3);
  const View view = random_view(64, 64, random);
  for (const int factor : {2, 4, 8}) {
    const int size = 64 / factor;
    const std::vector<float> tensor = crop_tensor(view, {{32, 32}, 64, 0}, size, 0, 255);
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        double mean = 0;
        for (int j = 0; j < factor; ++j) {
          for (int i = 0; i < factor; ++i) {
            mean += view.rgb[3 * static_cast<std::size_t>((row * factor + j) * 64 + column * factor + i)];
          }
        }
        mean /= factor * factor;
        EXPECT_NEAR(tensor[static_cast<std::size_t>(row * size + column)], mean, 1e-3) << factor;
      }
    }
  }
}

TEST(CropTensor, ShrinkingSkipsNoPixel) {
  // One bright pixel anywhere must leave its whole energy behind, whatever the factor and turn.
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    View view = make_view(100, 100);
    const std::size_t pixel = 100 * (35 + random.below(30)) + 35 + random.below(30);
    view.rgb[3 * pixel] = 255;
    const float size = static_cast<float>(random.uniform(110, 300));
    const Region region{{50, 50}, size, static_cast<float>(random.uniform(-4, 4))};
    const std::vector<float> tensor = crop_tensor(view, region, 64, 0, 255);
    double energy = 0;
    for (std::size_t p = 0; p < 64 * 64; ++p) energy += tensor[p] - 190;
    const double area = size * size / 64 / 64;
    EXPECT_NEAR(energy * area, 65, 65 * 0.25) << "seed " << seed << " size " << size;
  }
}

TEST(CropTensor, OutsideTheImageIsBackground) {
  View view = make_view(20, 10);
  for (std::uint8_t& value : view.rgb) value = 0;
  const std::vector<float> far_away = crop_tensor(view, {{500, -300}, 40, 1}, 16, 0, 1);
  for (const float value : far_away) EXPECT_NEAR(value, 190.0f / 255.0f, 1e-6f);

  const std::vector<float> letterboxed = crop_tensor(view, {{10, 5}, 20, 0}, 20, 0, 1);
  EXPECT_NEAR(letterboxed[0], 190.0f / 255.0f, 1e-6f);
  EXPECT_NEAR(letterboxed[10 * 20 + 10], 0.0f, 1e-6f);
  EXPECT_NEAR(letterboxed[19 * 20], 190.0f / 255.0f, 1e-6f);
}

TEST(CropTensor, RefusesRegionsWithoutSize) {
  const View view = make_view(20, 20);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Region& region :
       {Region{{10, 10}, 0, 0}, Region{{10, 10}, -3, 0}, Region{{10, 10}, nan, 0}, Region{{nan, 10}, 5, 0},
        Region{{10, 10}, 5, nan}, Region{{10, 10}, std::numeric_limits<float>::infinity(), 0}}) {
    EXPECT_THROW(crop_tensor(view, region, 16, 0, 1), Error);
  }
}

}  // namespace
}  // namespace vitruvian
