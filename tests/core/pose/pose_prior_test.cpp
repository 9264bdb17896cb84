#include "pose/pose_prior.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include "base/error.h"
#include "base/sha256.h"
#include "core/pose/pose_fixtures.h"

namespace vitruvian {
namespace {

using testing::file_bytes;
using testing::shipped_prior;
using testing::test_side_poses;

struct Array {
  std::vector<std::uint32_t> shape;
  std::vector<float> values;
};
using Arrays = std::map<std::string, Array>;

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto* begin = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof value);
}

/// An array file (models/README.md) of f32 arrays, stored as they are, and the metadata.
std::vector<std::byte> array_file(const Arrays& arrays) {
  const std::string metadata = "{}";
  std::vector<std::byte> body, payload;
  append(body, static_cast<std::uint32_t>(arrays.size() + 1));
  append(body, std::uint32_t{0});
  const std::size_t payload_begin = 64 + 88 * (arrays.size() + 1);
  const auto entry = [&](const std::string& name, std::uint32_t type, std::vector<std::uint32_t> shape,
                         const void* data, std::size_t size) {
    char text[32] = {};
    name.copy(text, 31);
    append(body, text);
    append(body, type);
    append(body, static_cast<std::uint32_t>(shape.size()));
    shape.resize(4, 1);
    for (const std::uint32_t extent : shape) append(body, extent);
    append(body, std::uint64_t{0});
    append(body, static_cast<std::uint64_t>(payload_begin + payload.size()));
    append(body, static_cast<std::uint64_t>(size));
    append(body, std::uint64_t{0});
    const auto* begin = static_cast<const std::byte*>(data);
    payload.insert(payload.end(), begin, begin + size);
    payload.resize((payload.size() + 7) / 8 * 8);
  };
  for (const auto& [name, array] : arrays) {
    entry(name, 7, array.shape, array.values.data(), array.values.size() * sizeof(float));
  }
  entry("metadata", 0, {static_cast<std::uint32_t>(metadata.size())}, metadata.data(), metadata.size());
  body.insert(body.end(), payload.begin(), payload.end());

  std::vector<std::byte> file;
  for (const char c : std::string("VITRUARR")) file.push_back(static_cast<std::byte>(c));
  append(file, std::uint32_t{1});
  for (const char c : std::string("POSE")) file.push_back(static_cast<std::byte>(c));
  append(file, static_cast<std::uint64_t>(56 + body.size()));
  append(file, sha256(body));
  file.insert(file.end(), body.begin(), body.end());
  return file;
}

Array filled(std::vector<std::uint32_t> shape, float value) {
  std::size_t count = 1;
  for (const std::uint32_t extent : shape) count *= extent;
  return {std::move(shape), std::vector<float>(count, value)};
}

/// The smallest prior that is in order.
Arrays sound_arrays() {
  Arrays arrays;
  arrays["gaussian_mean"] = filled({69}, 0.1f);
  arrays["gaussian_precision"] = filled({69, 69}, 0);
  for (int k = 0; k < 69; ++k) arrays["gaussian_precision"].values[70 * k] = 2;
  arrays["limit_low"] = filled({69}, -1);
  arrays["limit_high"] = filled({69}, 1);
  for (const char* limb : {"limb_left_arm", "limb_right_arm", "limb_left_leg", "limb_right_leg"}) {
    arrays[limb] = filled({3, 2, 3}, 0.5f);
  }
  const auto layer = [&](const std::string& name, std::uint32_t outputs, std::uint32_t inputs) {
    arrays["vae_" + name + "_weight"] = filled({outputs, inputs}, 0.01f);
    arrays["vae_" + name + "_bias"] = filled({outputs}, 0.1f);
  };
  layer("encoder_0", 7, 63);
  layer("encoder_1", 8, 7);
  layer("mean", 4, 8);
  layer("decoder_0", 9, 4);
  layer("decoder_1", 10, 9);
  layer("decoder_2", 126, 10);
  return arrays;
}

void expect_bad_model(const std::vector<std::byte>& bytes, const std::string& named) {
  try {
    read_pose_prior(bytes, "some.vpp");
    FAIL() << "accepted, though " << named << " is wrong";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_model);
    const std::string message = error.what();
    EXPECT_NE(message.find("some.vpp"), std::string::npos) << message;
    EXPECT_NE(message.find(named), std::string::npos) << message;
  }
}

TEST(PosePrior, ReadsASoundFile) {
  Arrays arrays = sound_arrays();
  arrays["limb_left_leg"].values = {0, 1, 2, 0.3f, 0.4f, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  arrays["vae_encoder_0_weight"].values[64] = 5;
  const PosePrior prior = read_pose_prior(array_file(arrays), "some.vpp");
  EXPECT_FLOAT_EQ(static_cast<float>(prior.mean[68]), 0.1f);
  EXPECT_EQ(prior.precision(68, 68), 2);
  EXPECT_EQ(prior.limb(Limb::left_leg).configurations.cols(), 3);
  EXPECT_EQ(prior.limb(Limb::left_leg).configurations(2, 0), 2);
  EXPECT_FLOAT_EQ(static_cast<float>(prior.limb(Limb::left_leg).configurations(3, 0)), 0.3f);
  EXPECT_EQ(prior.limb(Limb::right_arm).upper_joint, 17);
  EXPECT_EQ(prior.vae.encoder[0].weight(1, 1), 5);
  EXPECT_EQ(prior.vae.latent_count(), 4);
  EXPECT_EQ(prior.metadata, "{}");
}

TEST(PosePrior, TheAutoencoderMayBeAbsent) {
  Arrays arrays = sound_arrays();
  for (auto it = arrays.begin(); it != arrays.end();) {
    it = it->first.rfind("vae_", 0) == 0 ? arrays.erase(it) : std::next(it);
  }
  EXPECT_TRUE(read_pose_prior(array_file(arrays), "some.vpp").vae.empty());
}

TEST(PosePrior, EveryArrayIsNeededInItsShape) {
  const Arrays sound = sound_arrays();
  for (const auto& [name, array] : sound) {
    Arrays arrays = sound;
    arrays.erase(name);
    expect_bad_model(array_file(arrays), name);

    arrays = sound;
    arrays[name] = filled({5, 5}, 0.1f);
    expect_bad_model(array_file(arrays), name == "vae_encoder_0_bias" ? "vae_encoder_0" : "");

    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      arrays = sound;
      arrays[name].values.back() = value;
      expect_bad_model(array_file(arrays), name);
    }
  }
}

TEST(PosePrior, RefusesValuesThatMakeNoSense) {
  const auto changed = [](const std::string& name, const std::function<void(std::vector<float>&)>& change) {
    Arrays arrays = sound_arrays();
    change(arrays[name].values);
    expect_bad_model(array_file(arrays), name);
  };
  changed("gaussian_precision", [](auto& v) { v[1] = 0.5f; });
  changed("gaussian_precision", [](auto& v) { v[70] = -2; });
  changed("gaussian_precision", [](auto& v) { v[1] = v[69] = 3; });
  changed("limit_low", [](auto& v) { v[40] = 1; });
  changed("limb_left_arm", [](auto& v) { v[0] = 4; });
  changed("limb_right_leg", [](auto& v) { v[17] = -3.5f; });
}

TEST(PosePrior, RefusesEmptyOrHugeLibrariesAndCodes) {
  Arrays arrays = sound_arrays();
  arrays["limb_left_arm"] = filled({0, 2, 3}, 0);
  expect_bad_model(array_file(arrays), "limb_left_arm");
  arrays = sound_arrays();
  arrays["vae_mean_weight"] = filled({2000, 8}, 0);
  expect_bad_model(array_file(arrays), "vae_mean_weight");
}

TEST(PosePrior, RefusesDamagedFiles) {
  const std::vector<std::byte> sound = array_file(sound_arrays());
  Random random(9);
  for (int k = 0; k < 200; ++k) {
    std::vector<std::byte> damaged = sound;
    const std::size_t at = random.below(static_cast<std::uint32_t>(sound.size()));
    damaged[at] ^= static_cast<std::byte>(1u << random.below(8));
    SCOPED_TRACE("seed 9, byte " + std::to_string(at));
    expect_bad_model(damaged, "some.vpp");
  }
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{7}, std::size_t{63}, sound.size() / 2, sound.size() - 1}) {
    expect_bad_model({sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size)}, "some.vpp");
  }
}

TEST(ShippedPosePrior, IsWithinItsOwnLimits) {
  const PosePrior& prior = shipped_prior();
  EXPECT_TRUE((prior.mean.array() > prior.limit_low.array()).all());
  EXPECT_TRUE((prior.mean.array() < prior.limit_high.array()).all());
  // The T-pose and every joint at rest must be allowed.
  EXPECT_TRUE((prior.limit_low.array() < 0).all());
  EXPECT_TRUE((prior.limit_high.array() > 0).all());
}

TEST(ShippedPosePrior, IsLeftRightSymmetric) {
  const PosePrior& prior = shipped_prior();
  constexpr int kMirror[] = {1,  0,  2,  4,  3,  5,  7,  6,  8,  10, 9, 11,
                             13, 12, 14, 16, 15, 18, 17, 20, 19, 22, 21};
  for (int j = 0; j < 23; ++j) {
    for (int c = 0; c < 3; ++c) {
      const double sign = c == 0 ? 1 : -1;
      const int here = 3 * j + c, there = 3 * kMirror[j] + c;
      EXPECT_NEAR(prior.mean[here], sign * prior.mean[there], 1e-5);
      EXPECT_NEAR(prior.limit_low[here], c == 0 ? prior.limit_low[there] : -prior.limit_high[there], 1e-3);
    }
  }
}

TEST(ShippedPosePrior, FitsPosesItHasNotSeen) {
  const PosePrior& prior = shipped_prior();
  double worst_excess = 0;
  int outside = 0;
  for (const Points3d& pose : test_side_poses()) {
    const Eigen::Map<const Eigen::VectorXd> x(pose.data() + 3, 69);
    const Eigen::VectorXd difference = x - prior.mean;
    // A weak prior: even these unusual poses lie within two standard deviations on average.
    EXPECT_LT(difference.dot(prior.precision * difference) / 69, 4);
    const double excess = std::max((prior.limit_low - x).maxCoeff(), (x - prior.limit_high).maxCoeff());
    outside += excess > 0;
    worst_excess = std::max(worst_excess, excess);
  }
  EXPECT_LE(outside, 20);
  EXPECT_LT(worst_excess, 0.8);
}

TEST(ShippedPosePrior, HasLimbLibrariesOfTheSizesPromised) {
  const PosePrior& prior = shipped_prior();
  EXPECT_GE(prior.limb(Limb::left_arm).configurations.cols(), 240);
  EXPECT_GE(prior.limb(Limb::left_leg).configurations.cols(), 190);
  for (const auto& [left, right] :
       {std::pair{Limb::left_arm, Limb::right_arm}, {Limb::left_leg, Limb::right_leg}}) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> mirrored = prior.limb(right).configurations;
    for (const int row : {1, 2, 4, 5}) mirrored.row(row) *= -1;
    EXPECT_EQ(mirrored, prior.limb(left).configurations);
  }
}

}  // namespace
}  // namespace vitruvian
