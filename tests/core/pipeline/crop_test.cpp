#include "pipeline/crop.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "core/pipeline/all_knowing_network.h"

namespace vitruvian {
namespace {

std::string said_about(const std::string& text) {
  try {
    parse_crops(text, "c.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    return error.what();
  }
  return "";
}

TEST(Crop, RoundTrip) {
  const std::vector<CutVolume> crops = parse_crops(
      R"({"crops": [{"remove": "outside", "box": {"min": [-1, 0, 5], "max": [3, 1, 9]}},
                    {"remove": "inside", "clip_from_scan": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,-0.1,1]],
                     "polygon": [[0,0],[1,0.5],[0.25,1]]}]})",
      "c.json");
  ASSERT_EQ(crops.size(), 2u);
  EXPECT_TRUE(crops[0].contains({2.9, 0.1, 8.9}));
  EXPECT_FALSE(crops[0].contains({3.1, 0.1, 8.9}));
  EXPECT_FALSE(crops[0].contains({2.9, 0.1, 4.9}));
  EXPECT_EQ(parse_crops("{\"crops\": " + crops_to_json(crops).dump() + "}", "again"), crops);
}

TEST(Crop, BrokenFilesNameThePlace) {
  const std::string matrix = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"crops": []})", "crops: there is no crop"},
      {R"([])", "an object"},
      {R"({"crops": [{"box": {"min": [0,0,0], "max": [1,1,1]}}]})", "remove"},
      {R"({"crops": [{"remove": "both", "box": {"min": [0,0,0], "max": [1,1,1]}}]})", "crops[0].remove"},
      {R"({"crops": [{"remove": "inside"}]})", "crops[0]"},
      {R"({"crops": [{"remove": "inside", "box": {"min": [0,0,0], "max": [1,0,1]}}]})", "crops[0].box"},
      {R"({"crops": [{"remove": "inside", "box": {"min": [0,0,0], "max": [1,1e999,1]}}]})", "overflow"},
      {R"({"crops": [{"remove": "inside", "box_from_scan": [[0,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]})",
       "flattens"},
      {R"({"crops": [{"remove": "inside", "box_from_scan": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]}]})",
       "last row"},
      {R"({"crops": [{"remove": "inside", "clip_from_scan": )" + matrix + R"(, "polygon": [[0,0],[1,1]]}]})",
       "3 to"},
      {R"({"crops": [{"remove": "inside", "clip_from_scan": )" + matrix +
           R"(, "polygon": [[0,0],[1,1],[1]]}]})",
       "polygon[2]"},
  };
  for (const auto& [text, place] : cases)
    EXPECT_NE(said_about(text).find(place), std::string::npos) << text << "\n" << said_about(text);
}

CutVolume box_round(const Scan& scan, const std::vector<int>& vertices, double margin) {
  Points3d points(3, static_cast<Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i)
    points.col(static_cast<Index>(i)) = scan.vertices.col(vertices[i]).cast<double>() + scan.origin;
  CutVolume box;
  for (int i = 0; i < 3; ++i) {
    const double low = points.row(i).minCoeff() - margin, high = points.row(i).maxCoeff() + margin;
    box.volume_from_scan(i, i) = 2 / (high - low);
    box.volume_from_scan(i, 3) = -(high + low) / (high - low);
  }
  return box;
}

/// The standing body with a chair beside it, and the box that holds the body alone.
struct Scene {
  std::shared_ptr<const Scan> scan;
  CutVolume body_only;
};

Scene with_chair() {
  Scan scan = testing::scan_of(testing::standing());
  const Index body = scan.vertices.cols();
  std::vector<int> of_body;
  for (int i = 0; i < body; ++i) of_body.push_back(i);
  const CutVolume box = box_round(scan, of_body, 20);
  // The chair comes first in the file, so that the numbers of all that follow change.
  const Index chair = 400;
  Points3f vertices(3, chair + body);
  Random random(3);
  for (Index i = 0; i < chair; ++i) {
    const Vec3d at(random.uniform(900, 1500), random.uniform(-300, 300), random.uniform(-900, 100));
    vertices.col(i) = at.cast<float>();
  }
  vertices.rightCols(body) = scan.vertices;
  Faces faces(3, scan.faces.cols() + chair - 2);
  for (int i = 0; i < chair - 2; ++i) faces.col(i) << i, i + 1, i + 2;
  faces.rightCols(scan.faces.cols()) = scan.faces.array() + static_cast<int>(chair);
  scan.vertices = vertices;
  scan.faces = faces;
  scan.sha256 = "of the scan with the chair";
  CutVolume keep = box;
  keep.remove = CutVolume::Remove::outside;
  return {std::make_shared<const Scan>(std::move(scan)), keep};
}

Registration registered(RegistrationPipeline& pipeline) {
  const testing::AllKnowingNetwork network(testing::standing());
  while (const auto request = pipeline.next_request()) pipeline.accept(network.run(pipeline, *request));
  return pipeline.finish();
}

TEST(Crop, LeavesTheBodyAsIfItHadBeenScannedAlone) {
  const Scene scene = with_chair();
  const CroppedScan cropped = crop_scan(scene.scan, {scene.body_only});
  const Scan alone = testing::scan_of(testing::standing());
  EXPECT_EQ(cropped.scan->vertices, alone.vertices);
  EXPECT_EQ(cropped.scan->faces, alone.faces);
  EXPECT_EQ(cropped.scan->sha256, scene.scan->sha256);
  EXPECT_EQ(cropped.kept.front(), 400);

  Settings settings = testing::pca_settings();
  settings.crops = {scene.body_only};
  const Execution execution(2);
  RegistrationPipeline with_crop(testing::models(), settings, execution);
  with_crop.set_scan(scene.scan);
  const Registration result = registered(with_crop);
  RegistrationPipeline of_body(testing::models(), testing::pca_settings(), execution);
  of_body.set_scan(alone);
  const Registration expected = registered(of_body);
  EXPECT_EQ(result.registered_vertices, expected.registered_vertices);
  EXPECT_EQ(result.verdict.status, VerdictStatus::ok);
  EXPECT_EQ(result.scan.vertices, scene.scan->vertices.cols()) << "the file's own count";
  EXPECT_EQ(result.scan.faces, scene.scan->faces.cols());
}

TEST(Crop, CanBeChangedBetweenStagesAndKeepsTheNumbersOfRegions) {
  const Scene scene = with_chair();
  Settings settings = testing::pca_settings();
  RegionSet regions;
  regions.scan_sha256 = scene.scan->sha256;
  regions.model_sha256 = testing::models().body.sha256;
  RegionSet::Pair head{"head", {}, {}};
  for (int v = 0; v < testing::models().body.vertex_count(); ++v) {
    if (testing::models().body.segment[static_cast<std::size_t>(v)] != 15) continue;
    head.template_vertices.push_back(v);
    head.scan_vertices.push_back(400 + v);
  }
  regions.pairs = {head};
  settings.regions = regions;
  const Execution execution(2);
  RegistrationPipeline pipeline(testing::models(), settings, execution);
  pipeline.set_scan(scene.scan);
  const testing::AllKnowingNetwork network(testing::standing());
  while (const auto request = pipeline.next_request(PipelineStage::align))
    pipeline.accept(network.run(pipeline, *request));
  settings.crops = {scene.body_only};
  pipeline.configure(settings);
  EXPECT_FALSE(pipeline.reached(PipelineStage::align));
  const Registration changed = registered(pipeline);
  RegistrationPipeline fresh(testing::models(), settings, execution);
  fresh.set_scan(scene.scan);
  EXPECT_EQ(changed.registered_vertices, registered(fresh).registered_vertices);
  EXPECT_EQ(changed.verdict.status, VerdictStatus::ok);
  EXPECT_LT(changed.surface_error->surface_all.mean_mm, 3);
}

TEST(Crop, ThatLeavesNothingIsRefused) {
  const Scene scene = with_chair();
  CutVolume all = scene.body_only;
  all.remove = CutVolume::Remove::inside;
  for (const std::vector<CutVolume>& crops : {std::vector<CutVolume>{scene.body_only, all}}) {
    try {
      crop_scan(scene.scan, crops);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      EXPECT_NE(std::string(error.what()).find("cut less away"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace vitruvian
