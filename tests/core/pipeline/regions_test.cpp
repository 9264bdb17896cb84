#include "pipeline/regions.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "core/body/random_model.h"

namespace vitruvian {
namespace {

std::string said_about(const std::string& text) {
  try {
    parse_regions(text, "r.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    return error.what();
  }
  return "";
}

BodyModel model() {
  BodyModel result = testing::random_model(1, 4, 10, 2, 2);
  result.sha256 = "model";
  return result;
}

Scan scan_of(Index vertices) {
  Scan scan;
  scan.file_name = "a.ply";
  scan.sha256 = "scan";
  scan.vertices = Points3f::Zero(3, vertices);
  return scan;
}

RegionSet two_pairs() { return {"scan", "model", {{"hand", {5, 0}, {9}}, {"foot", {2}, {1, 3}}}}; }

TEST(Regions, LabelEveryVertexOnBothSides) {
  const RegionLabels labels = region_labels(two_pairs(), scan_of(6), model());
  EXPECT_EQ(labels.count, 3);
  EXPECT_EQ(labels.scan, (std::vector<int>{1, 0, 2, 0, 0, 1}));
  EXPECT_EQ(labels.vertices, (std::vector<int>{0, 2, 0, 2, 0, 0, 0, 0, 0, 1}));
}

TEST(Regions, AreRefusedForAnotherScanOrModelOrMissingVertices) {
  const auto said = [](const RegionSet& regions, const Scan& scan) -> std::string {
    try {
      region_labels(regions, scan, model());
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      return error.what();
    }
    return "";
  };
  RegionSet other = two_pairs();
  other.scan_sha256 = "x";
  EXPECT_NE(said(other, scan_of(6)).find("scan_sha256"), std::string::npos);
  other = two_pairs();
  other.model_sha256 = "x";
  EXPECT_NE(said(other, scan_of(6)).find("model_sha256"), std::string::npos);
  EXPECT_NE(said(two_pairs(), scan_of(5)).find("scan vertex 5"), std::string::npos);
  other = two_pairs();
  other.pairs[0].template_vertices = {10};
  EXPECT_NE(said(other, scan_of(6)).find("template vertex 10"), std::string::npos);
}

TEST(Regions, BrokenFilesNameThePlace) {
  const std::string head = R"({"scan_sha256": "s", "model_sha256": "m", "pairs": )";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{", "line 1"},
      {"{}", "scan_sha256"},
      {head + "[]}", "pairs: there is no pair"},
      {head + R"([{"name": "a", "scan_vertices": [], "template_vertices": [1]}]})", "scan_vertices"},
      {head + R"([{"name": "a", "scan_vertices": [-1], "template_vertices": [1]}]})", "scan_vertices[0]"},
      {head + R"([{"name": "a", "scan_vertices": [0.5], "template_vertices": [1]}]})", "scan_vertices[0]"},
      {head + R"([{"name": "a", "scan_vertices": [1e10], "template_vertices": [1]}]})", "scan_vertices[0]"},
      {head + R"([{"name": "a", "scan_vertices": [1, 1], "template_vertices": [1]}]})", "named before"},
      {head + R"([{"name": "a", "scan_vertices": [1], "template_vertices": [7]},
                  {"name": "b", "scan_vertices": [2], "template_vertices": [3, 7]}]})",
       "pairs[1].template_vertices[1]"},
  };
  for (const auto& [text, place] : cases) {
    const std::string said = said_about(text);
    EXPECT_NE(said.find("r.json"), std::string::npos) << text;
    EXPECT_NE(said.find(place), std::string::npos) << text << "\n" << said;
  }
}

TEST(Regions, RoundTrip) {
  const RegionSet back = parse_regions(regions_to_json(two_pairs()).dump(), "r.json");
  EXPECT_EQ(back.scan_sha256, "scan");
  EXPECT_EQ(back.model_sha256, "model");
  ASSERT_EQ(back.pairs.size(), 2u);
  EXPECT_EQ(back.pairs[0].name, "hand");
  EXPECT_EQ(back.pairs[0].scan_vertices, (std::vector<int>{5, 0}));
  EXPECT_EQ(back.pairs[1].template_vertices, (std::vector<int>{1, 3}));
}

}  // namespace
}  // namespace vitruvian
