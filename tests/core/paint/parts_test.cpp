#include "paint/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>

#include "base/error.h"
#include "base/random.h"

namespace vitruvian {
namespace {

TEST(ScanSegments, NearestVertexDecidesWithinReach) {
  Points3f body(3, 3), scan(3, 5);
  body << 0, 1, 2, 0, 0, 0, 0, 0, 0;
  scan << 0.1f, 0.6f, 2.0f, 2.0f, std::nanf(""), 0, 0, 0.05f, 0.3f, 0, 0, 0, 0, 0, 0;
  const std::vector<std::uint8_t> segment = {5, 5, 23};
  EXPECT_EQ(scan_segments(scan, body, segment, 0.2f),
            (std::vector<std::uint8_t>{5, kNoSegment, 23, kNoSegment, kNoSegment}));
}

TEST(Flood, ReachesWhatASearchOverNeighboursReaches) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const int count = 60;
    Faces faces(3, 40);
    for (Index k = 0; k < faces.size(); ++k) faces.data()[k] = static_cast<int>(random.below(count));
    std::vector<std::uint8_t> label;
    for (int i = 0; i < count; ++i) label.push_back(static_cast<std::uint8_t>(random.below(2)));
    const int start = static_cast<int>(random.below(count));

    std::set<int> reached = {start};
    std::queue<int> open({start});
    while (!open.empty()) {
      const int at = open.front();
      open.pop();
      for (Index f = 0; f < faces.cols(); ++f) {
        for (int a = 0; a < 3; ++a) {
          for (int b = 0; b < 3; ++b) {
            const int to = faces(b, f);
            const bool same = label[static_cast<std::size_t>(to)] == label[static_cast<std::size_t>(start)];
            if (faces(a, f) == at && same && reached.insert(to).second) open.push(to);
          }
        }
      }
    }
    EXPECT_EQ(flood(faces, label, start), std::vector<int>(reached.begin(), reached.end()));
  }
}

TEST(Flood, RefusesAVertexThatIsNone) {
  const std::vector<std::uint8_t> label = {0, 0};
  EXPECT_THROW(flood(Faces(3, 0), label, 2), Error);
  EXPECT_THROW(flood(Faces(3, 0), label, -1), Error);
  EXPECT_EQ(flood(Faces(3, 0), label, 1), std::vector<int>{1});
}

}  // namespace
}  // namespace vitruvian
