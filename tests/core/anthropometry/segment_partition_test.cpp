#include "anthropometry/segment_partition.h"

#include <gtest/gtest.h>

#include <map>

#include "core/anthropometry/measured_body.h"
#include "core/geometry/solids.h"
#include "geometry/mass_properties.h"

namespace vitruvian {
namespace {

/// Every edge is walked as often one way as the other.
bool is_closed(const Faces& faces) {
  std::map<std::pair<int, int>, int> balance;
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = faces(k, f), b = faces((k + 1) % 3, f);
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, count] : balance) {
    if (count != 0) return false;
  }
  return true;
}

void expect_sound(const SegmentPartition& partition, const Points3d& vertices, double volume, double area) {
  const Points3d nodes = partition.nodes(vertices);
  double volumes = 0, areas = 0;
  std::array<double, kSegmentCount> of_segment{};
  for (int s = 0; s < kSegmentCount; ++s) {
    const auto surface = partition.closed(1u << s);
    EXPECT_TRUE(is_closed(surface.faces)) << s;
    EXPECT_EQ(static_cast<Index>(surface.segment.size()), surface.faces.cols());
    of_segment[static_cast<std::size_t>(s)] = mass_properties(nodes, surface.faces).volume;
    volumes += of_segment[static_cast<std::size_t>(s)];
    areas += surface_area(nodes, partition.skin(1u << s));
  }
  EXPECT_NEAR(volumes, volume, 1e-9 * std::abs(volume));
  EXPECT_NEAR(areas, area, 1e-9 * area);
  Random random(9);
  for (int round = 0; round < 10; ++round) {
    const SegmentSet set = random.below(kAllSegments);
    const auto surface = partition.closed(set);
    EXPECT_TRUE(is_closed(surface.faces));
    double sum = 0;
    for (int s = 0; s < kSegmentCount; ++s) sum += set >> s & 1 ? of_segment[static_cast<std::size_t>(s)] : 0;
    EXPECT_NEAR(mass_properties(nodes, surface.faces).volume, sum, 1e-9 * std::abs(volume));
  }
}

TEST(SegmentPartition, VolumesOfTheDefaultBodyAddUpInAnyShapeAndPose) {
  const BodyModel& body = testing::made_body();
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Points3d vertices = posed_vertices<double>(body, testing::moved_state(seed, 0.2 * seed));
    expect_sound(testing::measured_body().partition(), vertices, mass_properties(vertices, body.faces).volume,
                 surface_area(vertices, body.faces));
  }
}

TEST(SegmentPartition, AnyLabelsAtAll) {
  const testing::Solid ball = testing::sphere(14, 16);
  const Points3d vertices = ball.vertices.cast<double>();
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<std::uint8_t> labels;
    for (Index v = 0; v < vertices.cols(); ++v) labels.push_back(static_cast<std::uint8_t>(random.below(24)));
    expect_sound(SegmentPartition(ball.faces, labels), vertices, mass_properties(vertices, ball.faces).volume,
                 surface_area(vertices, ball.faces));
  }
}

TEST(SegmentPartition, HolesAreCapped) {
  const testing::Solid ball = testing::sphere(24, 30);
  const Points3d vertices = ball.vertices.cast<double>();
  // Without its last faces, which lie round the lower pole.
  const Faces open = ball.faces.leftCols(ball.faces.cols() - 60);
  std::vector<std::uint8_t> labels;
  for (Index v = 0; v < vertices.cols(); ++v) labels.push_back(vertices(0, v) > 0 ? 3 : 0);
  const SegmentPartition partition(open, labels);
  EXPECT_TRUE(is_closed(partition.closed(kAllSegments).faces));
  EXPECT_TRUE(is_closed(partition.closed(1u << 3).faces));
  const Points3d nodes = partition.nodes(vertices);
  const double whole = mass_properties(nodes, partition.closed(kAllSegments).faces).volume,
               half = mass_properties(nodes, partition.closed(1u << 3).faces).volume;
  EXPECT_GT(whole, 0.97 * mass_properties(vertices, ball.faces).volume);
  EXPECT_LT(whole, mass_properties(vertices, ball.faces).volume);
  EXPECT_NEAR(half / whole, 0.5, 0.05);
}

}  // namespace
}  // namespace vitruvian
