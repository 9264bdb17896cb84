#include "base/array_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "base/sha256.h"

namespace vitruvian {
namespace {

std::string fixture() {
  std::ifstream file(std::string(VITRUVIAN_SOURCE_DIR) + "/tests/fixtures/io/arrays.vbm", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

template <class T>
void put(std::string& bytes, std::size_t position, T value) {
  std::memcpy(bytes.data() + position, &value, sizeof value);
}

/// Makes size and hash true again after the bytes have been changed.
void seal(std::string& bytes) {
  put(bytes, 16, static_cast<std::uint64_t>(bytes.size()));
  const Sha256::Digest digest = sha256(std::as_bytes(std::span(bytes)).subspan(56));
  std::memcpy(bytes.data() + 24, digest.data(), digest.size());
}

/// A file with one stored array.
std::string one_array(const std::string& name, std::uint32_t type, const std::vector<std::uint32_t>& shape,
                      const std::string& payload) {
  std::string bytes(64 + 88, '\0');
  std::memcpy(bytes.data(), "VITRUARR\x01\0\0\0BODY", 16);
  put(bytes, 56, std::uint32_t{1});
  std::memcpy(bytes.data() + 64, name.data(), name.size());
  put(bytes, 64 + 32, type);
  put(bytes, 64 + 36, static_cast<std::uint32_t>(shape.size()));
  for (std::size_t k = 0; k < 4; ++k) put(bytes, 64 + 40 + 4 * k, k < shape.size() ? shape[k] : 1u);
  put(bytes, 64 + 64, std::uint64_t{64 + 88});
  put(bytes, 64 + 72, static_cast<std::uint64_t>(payload.size()));
  bytes += payload;
  seal(bytes);
  return bytes;
}

ArrayFile open(const std::string& bytes, std::string_view kind = "BODY") {
  return ArrayFile(std::as_bytes(std::span(bytes)), kind, "test.vbm");
}

std::string raw_floats(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

using Shape = std::vector<std::size_t>;

TEST(ArrayFile, ReadsWhatThePythonWriterWrote) {
  const std::string bytes = fixture();
  const ArrayFile file = open(bytes);
  EXPECT_TRUE(file.has("half"));
  EXPECT_FALSE(file.has("hal"));
  EXPECT_EQ(file.shape("quantised"), (Shape{100, 4, 3}));
  const std::vector<float> quantised = file.floats("quantised", Shape{100, 4, 3});
  for (int i = 0; i < 1200; ++i) ASSERT_EQ(quantised[i], 0.5f * (i - 600));
  const std::vector<float> half = file.floats("half", Shape{1000});
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(half[i], i / 4.0f);
  const std::vector<float> wide = file.floats("wide", Shape{500});
  for (int i = 0; i < 500; ++i) ASSERT_EQ(wide[i], static_cast<float>(i / 7.0));
  const std::vector<std::int32_t> index = file.integers("index", Shape{70000}, 0, 69999);
  for (int i = 0; i < 70000; ++i) ASSERT_EQ(index[i], i);
  EXPECT_EQ(file.integers("tiny", Shape{3}, 1, 3), (std::vector<std::int32_t>{3, 1, 2}));
  EXPECT_EQ(file.text("metadata"), "{\"name\": \"fixture\"}");
}

TEST(ArrayFile, RefusesWrongShapesRangesTypesAndNames) {
  const std::string bytes = fixture();
  const ArrayFile file = open(bytes);
  EXPECT_THROW(file.floats("half", Shape{999}), Error);
  EXPECT_THROW(file.floats("half", Shape{1000, 1}), Error);
  EXPECT_THROW(file.integers("tiny", Shape{3}, 1, 2), Error);
  EXPECT_THROW(file.integers("tiny", Shape{3}, 2, 3), Error);
  EXPECT_THROW(file.integers("half", Shape{1000}, 0, 1000), Error);
  EXPECT_THROW(file.text("half"), Error);
  EXPECT_THROW(file.shape("none"), Error);
  EXPECT_THROW(open(bytes, "POSE"), Error);
}

TEST(ArrayFile, ErrorsNameFileAndArray) {
  const std::string bytes = fixture();
  try {
    open(bytes).floats("half", Shape{7});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_model);
    EXPECT_NE(std::string(error.what()).find("test.vbm"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("half"), std::string::npos);
  }
}

TEST(ArrayFile, RefusesNumbersThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const std::string bytes = one_array("x", 7, {2}, raw_floats({1, bad}));
    EXPECT_THROW(open(bytes).floats("x", Shape{2}), Error);
  }
  const double too_large = 1e300;
  const std::string wide = one_array("x", 8, {1}, {reinterpret_cast<const char*>(&too_large), 8});
  EXPECT_THROW(open(wide).floats("x", Shape{1}), Error);
}

TEST(ArrayFile, ReadsFullNamesAndEmptyArrays) {
  const std::string name(32, 'n');
  const std::string bytes = one_array(name, 7, {0, 3}, "");
  EXPECT_TRUE(open(bytes).floats(name, Shape{0, 3}).empty());
}

TEST(ArrayFile, RefusesEveryLieOfTheDirectory) {
  const std::string good = one_array("x", 7, {2, 3}, raw_floats({1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(open(good).floats("x", Shape{2, 3}).size(), 6u);
  const auto expect_refused = [&](const char* what, const std::function<void(std::string&)>& change) {
    std::string bytes = good;
    change(bytes);
    seal(bytes);
    EXPECT_THROW(open(bytes), Error) << what;
  };
  expect_refused("magic", [](std::string& b) { b[0] = 'v'; });
  expect_refused("version", [](std::string& b) { b[8] = 2; });
  expect_refused("array count", [](std::string& b) { put(b, 56, 0x7fffffffu); });
  expect_refused("reserved", [](std::string& b) { b[60] = 1; });
  expect_refused("no name", [](std::string& b) { b[64] = 0; });
  expect_refused("bytes behind the name", [](std::string& b) { b[64 + 5] = 'y'; });
  expect_refused("type", [](std::string& b) { b[64 + 32] = 9; });
  expect_refused("rank 0", [](std::string& b) { b[64 + 36] = 0; });
  expect_refused("rank 5", [](std::string& b) { b[64 + 36] = 5; });
  expect_refused("shape", [](std::string& b) { b[64 + 40] = 3; });
  expect_refused("huge shape", [](std::string& b) {
    for (int k = 0; k < 4; ++k) put(b, 64 + 40 + 4 * k, 0xffffffffu), b[64 + 36] = 4;
  });
  expect_refused("unused extent", [](std::string& b) { b[64 + 48] = 2; });
  expect_refused("encoding", [](std::string& b) { b[64 + 56] = 2; });
  expect_refused("reserved in entry", [](std::string& b) { b[64 + 60] = 1; });
  expect_refused("offset into the header", [](std::string& b) { put(b, 64 + 64, std::uint64_t{8}); });
  expect_refused("offset beyond", [](std::string& b) { put(b, 64 + 64, std::uint64_t{1} << 63); });
  expect_refused("stored size", [](std::string& b) { put(b, 64 + 72, std::uint64_t{25}); });
  expect_refused("stored size, huge", [](std::string& b) { put(b, 64 + 72, ~std::uint64_t{0}); });
  expect_refused("padding", [](std::string& b) { b[64 + 87] = 1; });
}

TEST(ArrayFile, RefusesTruncationAndEveryUnsealedChange) {
  const std::string good = fixture();
  for (std::size_t length = 0; length < good.size(); length += length < 200 ? 1 : 997) {
    const std::string bytes = good.substr(0, length);
    EXPECT_THROW(open(bytes), Error) << length;
  }
  const std::uint32_t seed = 21;
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    std::string bytes = good;
    bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] ^= static_cast<char>(1 + random.below(255));
    EXPECT_THROW(open(bytes), Error) << "seed " << seed << " round " << round;
  }
}

TEST(ArrayFile, SealedChangesGiveErrorsOrNumbersAndNeverCrash) {
  const std::string good = fixture();
  const std::uint32_t seed = 22;
  Random random(seed);
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string bytes = good;
    for (int change = 0; change < 3; ++change) {
      bytes[56 + random.below(static_cast<std::uint32_t>(64 + 7 * 88 + 2000 - 56))] ^=
          static_cast<char>(1 + random.below(255));
    }
    seal(bytes);
    try {
      const ArrayFile file = open(bytes);
      for (const char* name : {"quantised", "half", "tiny", "index", "wide"}) {
        if (file.has(name)) file.floats(name, file.shape(name));
      }
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.code(), ErrorCode::bad_model) << "seed " << seed << " round " << round;
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace vitruvian
