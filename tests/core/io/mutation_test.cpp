#include "base/random.h"
#include "core/io/test_files.h"
#include "fuzz/fuzz_io.h"

namespace vitruvian::test {
namespace {

/// Changes bytes, cuts, repeats and deletes pieces, and plants numbers that break careless readers.
std::string mutated(std::string content, Random& random) {
  static const std::string kPlants[] = {std::string("\xff\xff\xff\xff", 4),
                                        std::string("\0\0\0\x80", 4),
                                        std::string(8, '\0'),
                                        "-1",
                                        "4294967296",
                                        "99999999999999999999",
                                        "nan",
                                        "1e999",
                                        "\n",
                                        "\\\n",
                                        "/",
                                        "[",
                                        "\"",
                                        "\x7f\xff\xff\xff"};
  const std::uint32_t changes = 1 + random.below(4);
  for (std::uint32_t n = 0; n < changes && !content.empty(); ++n) {
    const std::uint32_t position = random.below(static_cast<std::uint32_t>(content.size()));
    const std::uint32_t length = random.below(20);
    switch (random.below(6)) {
      case 0:
        content[position] = static_cast<char>(random.below(256));
        break;
      case 1:
        content[position] = static_cast<char>(content[position] ^ (1 << random.below(8)));
        break;
      case 2:
        content.erase(position, length);
        break;
      case 3:
        content.insert(position,
                       content.substr(random.below(static_cast<std::uint32_t>(content.size())), length));
        break;
      case 4:
        content.replace(position, length, kPlants[random.below(std::size(kPlants))]);
        break;
      case 5:
        content.resize(position);
        break;
    }
  }
  return content;
}

TEST(Hostile, EveryTruncationOfEveryFormatGivesAnErrorOrASoundScan) {
  for (const NamedContent& file : one_of_every_format()) {
    for (std::size_t length = 0; length < file.content.size(); length += 7) {
      const std::string cut = file.content.substr(0, length);
      fuzz::read_any_scan(as_bytes(cut), file.name.c_str());
      fuzz::read_any_scan(as_bytes(cut), "scan");
    }
    // A scan without its last tenth is never taken for a whole one where the format has a count of its own.
    const bool has_count = file.name.find(".obj") == std::string::npos &&
                           file.name.find(".xyz") == std::string::npos &&
                           file.name.find(".pts") == std::string::npos;
    if (!has_count) continue;
    const std::string cut = file.content.substr(0, file.content.size() * 9 / 10);
    EXPECT_FALSE(fuzz::read_any_scan(as_bytes(cut), file.name.c_str())) << file.name;
  }
}

TEST(Hostile, MutationsOfEveryFormatGiveAnErrorOrASoundScan) {
  const std::uint32_t seed = 41;
  RecordProperty("seed", static_cast<int>(seed));
  Random random(seed);
  int accepted = 0, rounds = 0;
  for (const NamedContent& file : one_of_every_format()) {
    for (int round = 0; round < 1500; ++round, ++rounds) {
      const std::string bytes = mutated(file.content, random);
      accepted += fuzz::read_any_scan(as_bytes(bytes), round % 2 ? file.name.c_str() : "scan");
    }
  }
  // Harmless changes (a digit, a comment) are accepted, most others are not: both sides of the readers are
  // exercised.
  EXPECT_GT(accepted, rounds / 20) << "seed " << seed;
  EXPECT_LT(accepted, rounds * 19 / 20) << "seed " << seed;
}

TEST(Hostile, MutationsOfNumpyArchives) {
  const std::uint32_t seed = 42;
  Random random(seed);
  int accepted = 0;
  for (const char* name : {"stored.npz", "deflated.npz"}) {
    const std::string good = fixture(name);
    for (int round = 0; round < 1000; ++round) {
      const std::string bytes = mutated(good, random);
      accepted += fuzz::read_any_npz(as_bytes(bytes));
    }
  }
  // The archive holds Python objects, which are refused, so nothing is accepted whole.
  EXPECT_EQ(accepted, 0) << "seed " << seed;
}

TEST(Hostile, RandomBytesAndRandomText) {
  const std::uint32_t seed = 43;
  Random random(seed);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(random.below(400), '\0');
    const bool text = round % 2;
    for (char& c : bytes)
      c = text ? "0123456789.-e \nvfOply"[random.below(21)] : static_cast<char>(random.below(256));
    static const char* const kNames[] = {"a",     "a.ply",  "a.obj", "a.stl", "a.off",
                                         "a.glb", "a.gltf", "a.xyz", "a.pcd"};
    fuzz::read_any_scan(as_bytes(bytes), kNames[round % std::size(kNames)]);
  }
}

}  // namespace
}  // namespace vitruvian::test
