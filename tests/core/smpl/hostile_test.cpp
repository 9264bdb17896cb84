#include <cstdlib>
#include <filesystem>

#include "base/random.h"
#include "core/smpl/smpl_fixtures.h"
#include "fuzz/fuzz_models.h"

namespace vitruvian {
namespace {

using testing::smpl_file;

std::vector<std::byte> content(const std::string& name) {
  const FileBytes file(smpl_file(name));
  return {file.bytes().begin(), file.bytes().end()};
}

/// Changes, cuts, repeats and deletes bytes; mostly near the beginning, where a pickle has its instructions.
std::vector<std::byte> mutated(std::vector<std::byte> bytes, Random& random) {
  const std::uint32_t changes = 1 + random.below(4);
  for (std::uint32_t n = 0; n < changes && !bytes.empty(); ++n) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const std::uint32_t at = random.below(random.below(3) == 0 ? size : std::min(size, 3000u));
    switch (random.below(5)) {
      case 0:
        bytes[at] = static_cast<std::byte>(random.below(256));
        break;
      case 1:
        bytes[at] ^= static_cast<std::byte>(1u << random.below(8));
        break;
      case 2:
        bytes.erase(bytes.begin() + at, bytes.begin() + std::min(size, at + 1 + random.below(12)));
        break;
      case 3: {
        const std::uint32_t from = random.below(size), count = std::min(size - from, random.below(16));
        const std::vector<std::byte> piece(bytes.begin() + from, bytes.begin() + from + count);
        bytes.insert(bytes.begin() + at, piece.begin(), piece.end());
        break;
      }
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

TEST(HostileModels, EveryTruncationIsATypedError) {
  for (const char* name : {"tiny_smpl.pkl", "tiny_smpl2.pkl", "tiny_smpl.npz", "tiny_vposer.ckpt"}) {
    const std::vector<std::byte> whole = content(name);
    ASSERT_TRUE(fuzz::read_any_model(whole)) << name;
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 300);
    for (std::size_t length = 0; length < whole.size(); length += step)
      EXPECT_FALSE(fuzz::read_any_model({whole.data(), length})) << name << " cut to " << length;
  }
}

TEST(HostileModels, MutationsAreReadOrRefused) {
  const std::uint32_t seed = 71;
  Random random(seed);
  for (const char* name :
       {"tiny_smpl.pkl", "tiny_smpl2.pkl", "tiny_smpl.npz", "tiny_vposer.ckpt", "protocol0.pkl",
        "protocol1.pkl", "protocol2.pkl", "protocol3.pkl", "protocol4.pkl", "protocol5.pkl"}) {
    const std::vector<std::byte> whole = content(name);
    int refused = 0;
    const int rounds = whole.size() > 10'000 ? 150 : 1500;
    for (int round = 0; round < rounds; ++round) refused += !fuzz::read_any_model(mutated(whole, random));
    EXPECT_GT(refused, rounds / 4) << name << ", seed " << seed;
  }
}

/// Files that once brought the readers down, by fuzzing (tests/fuzz) or by thought.
TEST(HostileModels, FormerCrashersAreTypedErrors) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(VITRUVIAN_SOURCE_DIR "/tests/fuzz/crashers")) {
    const FileBytes file(entry.path().string());
    EXPECT_FALSE(fuzz::read_any_model(file.bytes())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 2);
}

TEST(HostileModels, ProtocolsZeroToFiveSayTheSame) {
  for (int protocol = 0; protocol <= 5; ++protocol) {
    const std::vector<std::byte> bytes = content("protocol" + std::to_string(protocol) + ".pkl");
    const PickleFile file(bytes, "protocol");
    const NumericArray small = numeric_array(*file.root().find("small"), "small");
    EXPECT_EQ(small.shape, (std::vector<std::size_t>{2, 3})) << protocol;
    EXPECT_EQ(small.values, (std::vector<double>{0, 1, 2, 3, 4, 5})) << protocol;
    EXPECT_EQ(numeric_array(*file.root().find("f"), "f").values, (std::vector<double>{0, 1, 2})) << protocol;
    EXPECT_EQ(numeric_array(*file.root().find("half"), "half").values, std::vector<double>{0.5}) << protocol;
  }
}

}  // namespace
}  // namespace vitruvian
