#include "base/sha256.h"

#include <gtest/gtest.h>

#include <string>

namespace vitruvian {
namespace {

std::string hash_of(const std::string& text) { return to_hex(sha256(std::as_bytes(std::span(text)))); }

TEST(Sha256, VectorsOfTheStandard) {
  EXPECT_EQ(hash_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hash_of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesGiveTheSameAsTheWhole) {
  std::string text;
  for (int i = 0; i < 400; ++i) text += static_cast<char>(i * 7);
  for (std::size_t length : {55u, 56u, 63u, 64u, 65u, 119u, 120u, 128u, 400u}) {
    for (std::size_t piece : {1u, 3u, 64u, 65u}) {
      Sha256 hash;
      for (std::size_t begin = 0; begin < length; begin += piece) {
        hash.update(std::as_bytes(std::span(text)).subspan(begin, std::min(piece, length - begin)));
      }
      EXPECT_EQ(to_hex(hash.finish()), hash_of(text.substr(0, length))) << length << " by " << piece;
    }
  }
}

}  // namespace
}  // namespace vitruvian
