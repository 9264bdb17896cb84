#include "body/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "base/sha256.h"
#include "body/forward.h"
#include "geometry/mesh.h"

namespace vitruvian {
namespace {

/// An array of a file under construction: everything is written as f32 or i32.
struct Array {
  std::vector<std::uint32_t> shape;
  std::vector<float> floats;
  std::vector<std::int32_t> integers;
  std::string text;
};

using Arrays = std::map<std::string, Array>;

template <typename T>
void put(std::string& bytes, std::size_t position, T value) {
  std::memcpy(bytes.data() + position, &value, sizeof value);
}

std::string file_of(const Arrays& arrays) {
  std::string bytes(64 + 88 * arrays.size(), '\0');
  std::memcpy(bytes.data(), "VITRUARR\x01\0\0\0BODY", 16);
  put(bytes, 56, static_cast<std::uint32_t>(arrays.size()));
  std::size_t entry = 64;
  for (const auto& [name, array] : arrays) {
    std::string payload = array.text;
    if (!array.floats.empty())
      payload.assign(reinterpret_cast<const char*>(array.floats.data()), 4 * array.floats.size());
    if (!array.integers.empty())
      payload.assign(reinterpret_cast<const char*>(array.integers.data()), 4 * array.integers.size());
    std::memcpy(bytes.data() + entry, name.data(), name.size());
    put(bytes, entry + 32, std::uint32_t{array.text.empty() ? (array.integers.empty() ? 7u : 5u) : 0u});
    put(bytes, entry + 36, static_cast<std::uint32_t>(array.shape.size()));
    for (std::size_t k = 0; k < 4; ++k)
      put(bytes, entry + 40 + 4 * k, k < array.shape.size() ? array.shape[k] : 1u);
    put(bytes, entry + 64, static_cast<std::uint64_t>(bytes.size()));
    put(bytes, entry + 72, static_cast<std::uint64_t>(payload.size()));
    bytes += payload;
    entry += 88;
  }
  put(bytes, 16, static_cast<std::uint64_t>(bytes.size()));
  const Sha256::Digest digest = sha256(std::as_bytes(std::span(bytes)).subspan(56));
  std::memcpy(bytes.data() + 24, digest.data(), digest.size());
  return bytes;
}

BodyModel read(const std::string& bytes) {
  return read_body_model(std::as_bytes(std::span(bytes)), "small.vbm");
}

/// A sound file: a tetrahedron with two joints and one shape component.
Arrays small_body() {
  Arrays a;
  a["v_template"] = {{4, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {}, {}};
  a["shapedirs"] = {{1, 4, 3}, std::vector<float>(12, 0.25f), {}, {}};
  a["faces"] = {{4, 3}, {}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, {}};
  a["parent"] = {{2}, {}, {-1, 0}, {}};
  a["joint_names"] = {{10}, {}, {}, "root\ntip\n\n"};
  a["skin_joint"] = {{4, 2}, {}, {0, 1, 0, 1, 1, 0, 1, 0}, {}};
  a["skin_weight"] = {{4, 2}, {}, {100, 300, 65535, 0, 1, 1, 30, 10}, {}};
  a["corrective_vertex"] = {{3}, {}, {0, 2, 3}, {}};
  a["corrective_joint"] = {{3}, {}, {1, 1, 1}, {}};
  a["corrective"] = {{3, 27}, std::vector<float>(81), {}, {}};
  std::iota(a["corrective"].floats.begin(), a["corrective"].floats.end(), 1.0f);
  a["regressor_joint"] = {{3}, {}, {0, 1, 1}, {}};
  a["regressor_vertex"] = {{3}, {}, {0, 1, 2}, {}};
  a["regressor_weight"] = {{3}, {1, 0.25f, 0.75f}, {}, {}};
  a["segment"] = {{4}, {}, {0, 23, 5, 7}, {}};
  a["mirror"] = {{4}, {}, {0, 2, 1, 3}, {}};
  a["prior_mean"] = {{3, 1}, {0.5f, -1, 1}, {}, {}};
  a["prior_precision"] = {{3, 1, 1}, {1, 2, 4}, {}, {}};
  return a;
}

TEST(ReadBodyModel, ReadsASmallBodyAsWritten) {
  const std::string bytes = file_of(small_body());
  const BodyModel model = read(bytes);
  EXPECT_EQ(model.vertex_count(), 4);
  EXPECT_EQ(model.face_count(), 4);
  EXPECT_EQ(model.joint_count(), 2);
  EXPECT_EQ(model.beta_count(), 1);
  EXPECT_EQ(model.joint_names, (std::vector<std::string>{"root", "tip"}));
  EXPECT_EQ(model.sha256, to_hex(sha256(std::as_bytes(std::span(bytes)))));
  EXPECT_EQ(model.v_template.col(2), Vec3f::UnitY());
  EXPECT_EQ(model.faces.col(3), Eigen::Vector3i(1, 2, 3));
  EXPECT_EQ(model.shapedirs(7, 0), 0.25f);
  // Weights come out in descending order, summing to one.
  EXPECT_EQ(model.skin_joint(0, 0), 1);
  EXPECT_EQ(model.skin_weight(0, 0), 0.75f);
  EXPECT_EQ(model.skin_weight(1, 0), 0.25f);
  EXPECT_EQ(model.skin_weight(1, 1), 0);
  EXPECT_EQ(model.corrective_begin, (std::vector<int>{0, 1, 1, 2, 3}));
  // Row-major: row xyz, column = element of R - I.
  EXPECT_EQ(model.corrective[1](0, 0), 28);
  EXPECT_EQ(model.corrective[1](0, 8), 36);
  EXPECT_EQ(model.corrective[1](2, 0), 46);
  EXPECT_EQ(model.joint_template.col(1), Vec3d(0.25, 0.75, 0));
  EXPECT_EQ(model.prior(Gender::female).mean[0], -1);
  EXPECT_EQ(model.prior(Gender::male).precision(0, 0), 4);
  EXPECT_NEAR(model.vertex_area.sum(), 1.5 + std::sqrt(3) / 2, 1e-6);
}

TEST(ReadBodyModel, CorrectivesAndMirrorMayBeMissing) {
  Arrays arrays = small_body();
  for (const char* name : {"corrective", "corrective_vertex", "corrective_joint", "mirror"})
    arrays.erase(name);
  const BodyModel model = read(file_of(arrays));
  EXPECT_TRUE(model.mirror.empty());
  EXPECT_EQ(model.corrective_begin, (std::vector<int>(5, 0)));
  EXPECT_EQ(posed_vertices<float>(model, BodyState::rest(model)).cols(), 4);
}

TEST(ReadBodyModel, RefusesEveryKindOfDamage) {
  struct Case {
    const char* name;
    std::function<void(Arrays&)> damage;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Case> cases = {
      {"too few vertices",
       [](Arrays& a) {
         a["v_template"].shape = {2, 6};
       }},
      {"flat template", [](Arrays& a) { a["v_template"].shape = {12}; }},
      {"template not a number", [=](Arrays& a) { a["v_template"].floats[5] = nan; }},
      {"template infinite",
       [](Arrays& a) { a["v_template"].floats[0] = std::numeric_limits<float>::infinity(); }},
      {"shape of other vertices",
       [](Arrays& a) {
         a["shapedirs"].shape = {2, 2, 3};
       }},
      {"shape without xyz", [](Arrays& a) { a["shapedirs"].shape = {12}; }},
      {"face beyond the vertices", [](Arrays& a) { a["faces"].integers[4] = 4; }},
      {"negative face", [](Arrays& a) { a["faces"].integers[4] = -1; }},
      {"faces of four",
       [](Arrays& a) {
         a["faces"].shape = {3, 4};
       }},
      {"two roots",
       [](Arrays& a) {
         a["parent"].integers = {-1, -1};
       }},
      {"no root",
       [](Arrays& a) {
         a["parent"].integers = {0, 0};
       }},
      {"own parent",
       [](Arrays& a) {
         a["parent"].integers = {-1, 1};
       }},
      {"name missing", [](Arrays& a) { a["joint_names"].text = "root\n\n\n\n\n\n"; }},
      {"name too many", [](Arrays& a) { a["joint_names"].text = "a\nb\nc\n\n\n\n\n"; }},
      {"weight of no joint", [](Arrays& a) { a["skin_joint"].integers[3] = 2; }},
      {"no weight at all", [](Arrays& a) { a["skin_weight"].integers[2] = 0; }},
      {"negative weight", [](Arrays& a) { a["skin_weight"].integers[1] = -300; }},
      {"weight too large", [](Arrays& a) { a["skin_weight"].integers[1] = 65536; }},
      {"weights of other vertices",
       [](Arrays& a) {
         a["skin_weight"].shape = a["skin_joint"].shape = {2, 4};
       }},
      {"corrective of the root", [](Arrays& a) { a["corrective_joint"].integers[0] = 0; }},
      {"corrective of no vertex", [](Arrays& a) { a["corrective_vertex"].integers[2] = 4; }},
      {"correctives not sorted",
       [](Arrays& a) {
         a["corrective_vertex"].integers = {2, 0, 3};
       }},
      {"corrective twice",
       [](Arrays& a) {
         a["corrective_vertex"].integers = {2, 2, 3};
       }},
      {"corrective of other size",
       [](Arrays& a) {
         a["corrective"].shape = {27, 3};
       }},
      {"corrective not a number", [=](Arrays& a) { a["corrective"].floats[80] = nan; }},
      {"regressor sum", [](Arrays& a) { a["regressor_weight"].floats[1] = 0.5f; }},
      {"joint without regressor",
       [](Arrays& a) {
         a["regressor_joint"].integers = {0, 0, 0};
       }},
      {"regressor of no joint", [](Arrays& a) { a["regressor_joint"].integers[0] = 2; }},
      {"regressor of no vertex", [](Arrays& a) { a["regressor_vertex"].integers[0] = 77; }},
      {"no such segment", [](Arrays& a) { a["segment"].integers[0] = 24; }},
      {"segments of other vertices",
       [](Arrays& a) {
         a["segment"].shape = {2, 2};
       }},
      {"mirror out of range", [](Arrays& a) { a["mirror"].integers[0] = 4; }},
      {"mirror not an involution",
       [](Arrays& a) {
         a["mirror"].integers = {1, 2, 3, 0};
       }},
      {"prior for two genders",
       [](Arrays& a) {
         a["prior_mean"].shape = {1, 3};
       }},
      {"prior not positive", [](Arrays& a) { a["prior_precision"].floats[2] = -1; }},
      {"prior singular", [](Arrays& a) { a["prior_precision"].floats[0] = 0; }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    Arrays arrays = small_body();
    c.damage(arrays);
    try {
      read(file_of(arrays));
      ADD_FAILURE() << "was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_model);
      EXPECT_NE(std::string(error.what()).find("small.vbm"), std::string::npos) << error.what();
    }
  }
}

TEST(ReadBodyModel, RefusesAFileWithoutAnyOneNeededArray) {
  const Arrays whole = small_body();
  for (const auto& [name, array] : whole) {
    if (name == "corrective" || name == "mirror") continue;
    SCOPED_TRACE(name);
    Arrays arrays = whole;
    arrays.erase(name);
    try {
      read(file_of(arrays));
      ADD_FAILURE() << "was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_model);
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

/// Bytes of the default body that scripts/start builds.
std::string default_body_file() {
  const char* folder = std::getenv("VITRUVIAN_DATA");
  std::ifstream file(std::string(folder ? folder : VITRUVIAN_MODELS_DIR) + "/body.vbm", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class DefaultBody : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(bytes().empty()) << "body.vbm is missing: build the models with scripts/start";
  }
  static const std::string& bytes() {
    static const std::string content = default_body_file();
    return content;
  }
  static const BodyModel& body() {
    static const BodyModel model = read(bytes());
    return model;
  }
};

TEST_F(DefaultBody, HasTheSkeletonOfSmpl) {
  ASSERT_EQ(body().joint_count(), 24);
  EXPECT_EQ(body().parent, (std::vector<int>{-1, 0, 0, 0,  1,  2,  3,  4,  5,  6,  7,  8,
                                             9,  9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21}));
  for (int j = 0; j < 24; ++j) EXPECT_EQ(body().joint_names[j], kSmplJointNames[j]);
}

TEST_F(DefaultBody, StandsInTheBodyFrame) {
  const auto joint = [&](int j) { return Vec3d(body().joint_template.col(j)); };
  EXPECT_LT(joint(0).norm(), 0.05) << "the origin is at the pelvis";
  EXPECT_GT(joint(15)[1], joint(0)[1] + 0.4) << "Y up";
  EXPECT_LT(joint(7)[1], joint(0)[1] - 0.6);
  EXPECT_GT(joint(20)[0], 0.5) << "left hand on +X";
  EXPECT_LT(joint(21)[0], -0.5);
  EXPECT_GT(joint(10)[2], joint(7)[2] + 0.05) << "toes in front, facing +Z";
  const float stature = body().v_template.row(1).maxCoeff() - body().v_template.row(1).minCoeff();
  EXPECT_GT(stature, 1.5f);
  EXPECT_LT(stature, 1.9f);
}

TEST_F(DefaultBody, IsAClosedSurfaceWithItsFacesOutward) {
  const double litres = 1000 * signed_volume(body().v_template, body().faces);
  EXPECT_GT(litres, 50);
  EXPECT_LT(litres, 110);
  std::map<std::pair<int, int>, int> edges;
  for (Index f = 0; f < body().faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) ++edges[{body().faces(k, f), body().faces((k + 1) % 3, f)}];
  }
  for (const auto& [edge, times] : edges) {
    ASSERT_EQ(times, 1);
    ASSERT_TRUE(edges.count({edge.second, edge.first})) << edge.first << " " << edge.second;
  }
  EXPECT_EQ(body().vertex_count() - body().face_count() / 2, 2) << "genus 0";
}

TEST_F(DefaultBody, IsSymmetricInShapeSkinAndSegments) {
  ASSERT_EQ(body().mirror.size(), static_cast<std::size_t>(body().vertex_count()));
  const auto other_side = [](int segment) {
    const std::string name(kSegmentNames[segment]);
    for (const auto& [from, to] : {std::pair("left_", "right_"), std::pair("right_", "left_")}) {
      if (name.rfind(from, 0) != 0) continue;
      const std::string partner = to + name.substr(std::strlen(from));
      return static_cast<int>(std::find(kSegmentNames.begin(), kSegmentNames.end(), partner) -
                              kSegmentNames.begin());
    }
    return segment;
  };
  float worst = 0, worst_shape = 0;
  for (int v = 0; v < body().vertex_count(); ++v) {
    const int m = body().mirror[v];
    const Vec3f flipped = Vec3f(-1, 1, 1).cwiseProduct(body().v_template.col(m));
    worst = std::max(worst, (flipped - body().v_template.col(v)).norm());
    for (int k = 0; k < body().beta_count(); ++k) {
      const Vec3f there = Vec3f(-1, 1, 1).cwiseProduct(body().shapedirs.block<3, 1>(3 * m, k));
      worst_shape = std::max(worst_shape, (there - body().shapedirs.block<3, 1>(3 * v, k)).norm());
    }
    if (std::abs(body().v_template(0, v)) > 0.01f) {
      EXPECT_EQ(body().segment[m], other_side(body().segment[v])) << v;
    }
  }
  EXPECT_LT(worst, 2e-4f);
  EXPECT_LT(worst_shape, 2e-4f);
}

TEST_F(DefaultBody, HasSoundWeightsAndEverySegment) {
  EXPECT_LT((body().skin_weight.colwise().sum().array() - 1).abs().maxCoeff(), 1e-5f);
  EXPECT_GE(body().skin_weight.minCoeff(), 0);
  std::array<double, 24> area{};
  for (int v = 0; v < body().vertex_count(); ++v) area[body().segment[v]] += body().vertex_area[v];
  for (int s = 0; s < 24; ++s) EXPECT_GT(area[s], 0.001) << kSegmentNames[s];
  EXPECT_GT(body().vertex_area.sum(), 1.4);
  EXPECT_LT(body().vertex_area.sum(), 2.4);
}

TEST_F(DefaultBody, MenAreTallerThanWomenInThePriors) {
  const auto stature = [&](Gender gender) {
    VertexMatrix<float> shaped;
    shape_vertices(body(), body().prior(gender).mean, shaped);
    return shaped.row(1).maxCoeff() - shaped.row(1).minCoeff();
  };
  EXPECT_GT(stature(Gender::male), stature(Gender::neutral) + 0.03f);
  EXPECT_LT(stature(Gender::female), stature(Gender::neutral) - 0.03f);
}

// A damaged download must never reach the maths.
TEST_F(DefaultBody, RefusesFlippedAndMissingBytes) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::string damaged = bytes();
    const std::uint32_t place = random.below(static_cast<std::uint32_t>(damaged.size()));
    if (seed % 3 == 0) {
      damaged.resize(place);
    } else {
      damaged[place] = static_cast<char>(damaged[place] ^ (1 << random.below(8)));
    }
    try {
      read(damaged);
      ADD_FAILURE() << "was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_model);
    }
  }
}

}  // namespace
}  // namespace vitruvian
