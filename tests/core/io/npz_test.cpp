#include "io/npz.h"

#include "base/random.h"
#include "core/io/test_files.h"

namespace vitruvian::test {
namespace {

class Npz : public testing::TestWithParam<const char*> {};

TEST_P(Npz, ReadsWhatNumpyWrote) {
  const std::string bytes = fixture(GetParam());
  const NpzFile file(as_bytes(bytes), GetParam());
  EXPECT_EQ(file.names().size(), 15u);
  const NumericArray f4 = file.array("f4");
  EXPECT_EQ(f4.shape, (std::vector<std::size_t>{2, 3, 4}));
  for (int i = 0; i < 24; ++i) EXPECT_EQ(f4.values[i], i / 8.0);
  for (const char* name : {"f8", "big_f8"}) {
    const NumericArray f8 = file.array(name);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(f8.values[i], i / 3.0) << name;
  }
  EXPECT_EQ(file.array("i4").values, (std::vector<double>{-3, -2, -1, 0, 1, 2}));
  EXPECT_EQ(file.array("i8").values, (std::vector<double>{-1099511627776.0, 1099511627776.0}));
  EXPECT_EQ(file.array("u1").values[255], 255);
  EXPECT_EQ(file.array("f2").values[0], 1.5);
  EXPECT_NEAR(file.array("f2").values[2], 6e-8, 1e-9);
  const NumericArray fortran = file.array("fortran");
  for (int i = 0; i < 24; ++i) EXPECT_EQ(fortran.values[i], i);
  EXPECT_TRUE(file.array("scalar").shape.empty());
  EXPECT_EQ(file.array("scalar").values, (std::vector<double>{2.5}));
  EXPECT_EQ(file.array("flag").values, (std::vector<double>{1, 0}));
  EXPECT_TRUE(file.array("empty").values.empty());
  EXPECT_EQ(file.text("gender"), "female");
  EXPECT_EQ(file.text("unicode"), "Ω✓");
  EXPECT_EQ(file.text("raw"), "abc");
  EXPECT_THROW(file.array("objects"), Error);
  EXPECT_THROW(file.array("gender"), Error);
  EXPECT_THROW(file.text("f4"), Error);
  EXPECT_THROW(file.array("none"), Error);
  EXPECT_FALSE(file.has("none"));
}

TEST_P(Npz, DamageGivesErrorsAndNeverOtherNumbers) {
  const std::string good = fixture(GetParam());
  const NpzFile original(as_bytes(good), "good");
  const std::uint32_t seed = 31;
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    std::string bytes = good;
    bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] ^= static_cast<char>(1 + random.below(255));
    try {
      const NpzFile file(as_bytes(bytes), "damaged");
      for (const char* name : {"f4", "i8", "fortran", "u1"}) {
        if (!file.has(name)) continue;
        EXPECT_EQ(file.array(name).values, original.array(name).values)
            << "seed " << seed << " round " << round;
      }
    } catch (const Error& error) {
      EXPECT_TRUE(error.code() == ErrorCode::bad_file || error.code() == ErrorCode::unsupported_format);
    }
  }
  for (std::size_t length = 0; length < good.size(); length += 7) {
    const std::string bytes = good.substr(0, length);
    EXPECT_THROW(NpzFile(as_bytes(bytes), "cut"), Error) << length;
  }
}

INSTANTIATE_TEST_SUITE_P(Archives, Npz, testing::Values("stored.npz", "deflated.npz"));

TEST(NpzWriter, ComesBack) {
  const std::vector<float> offsets = {1, 2, 3, 4, 5, 6};
  const std::vector<double> pose = {0.1, 0.2};
  const std::vector<std::int32_t> index = {-7};
  const NpzItem items[] = {{.name = "offsets", .shape = {2, 3}, .floats = offsets},
                           {.name = "pose", .shape = {2}, .doubles = pose},
                           {.name = "index", .shape = {}, .integers = index},
                           {.name = "nothing", .shape = {0, 3}}};
  const std::string bytes = to_npz(items);
  EXPECT_EQ(bytes, to_npz(items));
  const NpzFile file(as_bytes(bytes), "x.npz");
  EXPECT_EQ(file.names(), (std::vector<std::string>{"offsets", "pose", "index", "nothing"}));
  EXPECT_EQ(file.array("offsets").shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(file.array("offsets").values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file.array("pose").values, pose);
  EXPECT_EQ(file.array("index").values, (std::vector<double>{-7}));
  EXPECT_EQ(file.array("nothing").shape, (std::vector<std::size_t>{0, 3}));
}

TEST(NpzWriter, RefusesShapesThatDoNotFit) {
  const std::vector<float> offsets = {1, 2, 3};
  const NpzItem item = {.name = "offsets", .shape = {2, 3}, .floats = offsets};
  EXPECT_THROW(to_npz(std::span(&item, 1)), Error);
}

TEST(Npy, DamagedHeadersGiveErrors) {
  const std::string good = fixture("compressed_points.npy");
  EXPECT_EQ(read_npy(as_bytes(good), "a.npy").shape, (std::vector<std::size_t>{300, 3}));
  const std::uint32_t seed = 32;
  Random random(seed);
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string bytes = good;
    bytes[random.below(80)] = static_cast<char>(random.below(256));
    if (round % 3 == 0) bytes.resize(random.below(static_cast<std::uint32_t>(bytes.size())));
    try {
      const NumericArray array = read_npy(as_bytes(bytes), "a.npy");
      std::size_t count = 1;
      for (const std::size_t extent : array.shape) count *= extent;
      EXPECT_EQ(array.values.size(), count) << "seed " << seed << " round " << round;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 700);
}

}  // namespace
}  // namespace vitruvian::test
