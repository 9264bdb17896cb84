#include "base/inflate.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

std::vector<std::byte> fixture(const std::string& name) {
  std::ifstream file(std::string(VITRUVIAN_SOURCE_DIR) + "/tests/fixtures/io/" + name, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_FALSE(text.empty()) << name;
  std::vector<std::byte> bytes(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) bytes[i] = static_cast<std::byte>(text[i]);
  return bytes;
}

/// What tests/fixtures/io/make_fixtures.py packs.
std::vector<std::byte> fixture_content() {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += static_cast<char>((i * i / 7 + i) % 251);
  text.append(40000, 'A');
  for (int i = 0; i < 2000; ++i) text += "line " + std::to_string(i) + "\n";
  std::vector<std::byte> bytes(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) bytes[i] = static_cast<std::byte>(text[i]);
  return bytes;
}

TEST(Crc32, KnownValues) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc32(std::as_bytes(std::span(digits))), 0xcbf43926u);
  EXPECT_EQ(crc32({}), 0u);
}

TEST(Crc32, PiecesGiveTheSameAsTheWhole) {
  const std::vector<std::byte> content = fixture_content();
  const std::uint32_t whole = crc32(content);
  for (const std::size_t cut :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{8}, std::size_t{12345}}) {
    EXPECT_EQ(crc32(std::span(content).subspan(cut), crc32(std::span(content).first(cut))), whole) << cut;
  }
}

class InflateZlib : public testing::TestWithParam<const char*> {};

TEST_P(InflateZlib, GivesTheContent) {
  const std::vector<std::byte> content = fixture_content();
  EXPECT_EQ(inflate_zlib(fixture(GetParam()), content.size()), content);
}

TEST_P(InflateZlib, RefusesAnotherSize) {
  const std::size_t size = fixture_content().size();
  for (const std::size_t wrong : {std::size_t{0}, std::size_t{1}, size - 1, size + 1, 2 * size}) {
    EXPECT_THROW(inflate_zlib(fixture(GetParam()), wrong), Error) << wrong;
  }
}

TEST_P(InflateZlib, RefusesEveryTruncation) {
  const std::size_t size = fixture_content().size();
  const std::vector<std::byte> stream = fixture(GetParam());
  for (std::size_t length = 0; length < stream.size(); length += length < 40 ? 1 : 97) {
    EXPECT_THROW(inflate_zlib(std::span(stream).first(length), size), Error) << length;
  }
}

TEST_P(InflateZlib, NoChangedByteGoesUnnoticed) {
  const std::vector<std::byte> content = fixture_content();
  const std::vector<std::byte> stream = fixture(GetParam());
  const std::uint32_t seed = 11;
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::byte> damaged = stream;
    const std::size_t position = random.below(static_cast<std::uint32_t>(stream.size()));
    damaged[position] ^= static_cast<std::byte>(1 + random.below(255));
    // Header bytes hold a few bits that do not change the content (window size, level).
    try {
      EXPECT_EQ(inflate_zlib(damaged, content.size()), content) << "seed " << seed << " round " << round;
      EXPECT_LT(position, 2u) << "seed " << seed << " round " << round;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_file);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, InflateZlib, testing::Values("level0.zlib", "level9.zlib", "fixed.zlib"));

TEST(InflateRaw, GivesTheContentWithoutAnyByteAfterTheStream) {
  const std::vector<std::byte> content = fixture_content();
  for (const char* name : {"level0.zlib", "level9.zlib", "fixed.zlib"}) {
    const std::vector<std::byte> stream = fixture(name);
    const auto raw = std::span(stream).subspan(2, stream.size() - 6);
    EXPECT_EQ(inflate_raw(raw, content.size()), content) << name;
    EXPECT_THROW(inflate_raw(raw.first(raw.size() - 1), content.size()), Error) << name;
    EXPECT_THROW(inflate_raw(std::span(stream).subspan(2), content.size()), Error)
        << name << " with trailing bytes";
  }
}

TEST(InflateZlibSize, RefusesSizesThatNoStreamOfItsLengthCanHave) {
  const std::vector<std::byte> stream = fixture("level9.zlib");
  EXPECT_THROW(inflate_zlib(stream, std::size_t{1} << 31), Error);
}

TEST(InflateGzip, OneMemberAndMany) {
  const std::vector<std::byte> content = fixture_content();
  for (const char* name : {"one.gz", "many.gz"}) {
    const std::vector<std::byte> packed = fixture(name);
    EXPECT_TRUE(is_gzip(packed));
    EXPECT_EQ(inflate_gzip(packed, 1 << 20), content) << name;
  }
}

TEST(InflateGzip, KeepsToTheLimit) {
  const std::vector<std::byte> content = fixture_content();
  for (const char* name : {"one.gz", "many.gz"}) {
    EXPECT_EQ(inflate_gzip(fixture(name), content.size()), content) << name;
    EXPECT_THROW(inflate_gzip(fixture(name), content.size() - 1), Error) << name;
    EXPECT_THROW(inflate_gzip(fixture(name), 0), Error) << name;
  }
}

TEST(InflateGzip, RefusesTruncationAndDamage) {
  const std::vector<std::byte> content = fixture_content();
  const std::vector<std::byte> packed = fixture("one.gz");
  for (std::size_t length = 0; length < packed.size(); length += length < 40 ? 1 : 7) {
    EXPECT_THROW(inflate_gzip(std::span(packed).first(length), 1 << 20), Error) << length;
  }
  const std::uint32_t seed = 12;
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::byte> damaged = packed;
    damaged[random.below(static_cast<std::uint32_t>(packed.size()))] ^=
        static_cast<std::byte>(1 + random.below(255));
    try {
      // A change of the time stamp or the stored name does no harm; any other must be noticed.
      EXPECT_EQ(inflate_gzip(damaged, 1 << 20), content) << "seed " << seed << " round " << round;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_file);
    }
  }
}

TEST(InflateGzip, RefusesRubbishAfterTheLastMember) {
  std::vector<std::byte> packed = fixture("one.gz");
  packed.insert(packed.end(), 40, std::byte{7});
  EXPECT_THROW(inflate_gzip(packed, 1 << 20), Error);
}

}  // namespace
}  // namespace vitruvian
