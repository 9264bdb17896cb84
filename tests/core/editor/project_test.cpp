#include "editor/project.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "body/model.h"

namespace vitruvian {
namespace {

Mat4d lying() {
  Mat4d matrix;
  matrix << 0, 0.001, 0, -0.1 / 3, 0, 0, 0.001, -0.9, 0.001, 0, 0, 0.25, 0, 0, 0, 1;
  return matrix;
}

CutVolume lasso() {
  CutVolume cut;
  cut.shape = CutVolume::Shape::lasso;
  cut.volume_from_scan(3, 2) = -1.0 / 3;
  cut.polygon = {{0, 0}, {1.0 / 7, 0}, {0.5, 1}};
  return cut;
}

Project sample_project() {
  Project project;
  project.scan_file = "J\u00f6rg \"1\".ply";
  project.scan_sha256 = std::string(64, 'a');
  project.model_sha256 = std::string(64, 'b');
  project.settings.views = 2;
  project.settings.seed = 4294967295u;
  KeypointSet found;
  found.joints = {{"pelvis", {Vec3d(1.0 / 3, 2, 3), 0.5}}, {"head", {Vec3d(4, 5, 6), 1}}};
  project.edits = {
      {CropEdit{lasso()}, "Cut the chair away"},
      {KeypointsEdit{found}, ""},
      {AlignEdit{lying()}, ""},
      {JointsEdit{{{"head", KeypointSet::Joint{Vec3d(7, 8, 9), 1}}, {"pelvis", std::nullopt}}}, ""},
      {RegionsEdit{RegionSet{std::string(64, 'a'), std::string(64, 'b'), {{"hand", {1}, {2}}}}}, ""}};
  return project;
}

TEST(Project, RoundTripGivesTheSameBytesAndSettings) {
  const Project project = sample_project();
  const std::string text = project_json(project);
  const Project back = parse_project(text, "p.json");
  EXPECT_EQ(project_json(back), text);
  EXPECT_EQ(back.scan_file, project.scan_file);
  EXPECT_EQ(back.edits.size(), project.edits.size());
  EXPECT_EQ(back.edits[0].label, "Cut the chair away");
  EXPECT_EQ(with_edits(back.settings, back.edits), with_edits(project.settings, project.edits));
}

TEST(Project, EditsAreMadeInTheirOrder) {
  const Project project = sample_project();
  const Settings settings = with_edits(project.settings, project.edits);
  EXPECT_EQ(settings.crops, std::vector<CutVolume>{lasso()});
  EXPECT_EQ(*settings.body_from_scan, lying());
  ASSERT_EQ(settings.keypoints->joints.size(), 1u) << "the pelvis was removed";
  EXPECT_EQ(settings.keypoints->joints.at("head").position, Vec3d(7, 8, 9));
  EXPECT_EQ(settings.regions->pairs.front().name, "hand");
  EXPECT_EQ(settings.views, 2);

  // The whole set comes after the single joint: that is gone.
  std::vector<Edit> turned = {project.edits[3], project.edits[1]};
  EXPECT_EQ(with_edits({}, turned).keypoints->joints.at("head").position, Vec3d(4, 5, 6));
  turned.push_back({KeypointsEdit{}, ""});
  EXPECT_FALSE(with_edits({}, turned).keypoints);
  turned = {
      {CropEdit{lasso()}, ""}, {CropEdit{CutVolume()}, ""}, {AlignEdit{lying()}, ""}, {AlignEdit{}, ""}};
  EXPECT_EQ(with_edits({}, turned).crops.size(), 2u);
  EXPECT_FALSE(with_edits({}, turned).body_from_scan);
  turned = {{JointsEdit{{{"head", std::nullopt}}}, ""}};
  EXPECT_FALSE(with_edits({}, turned).keypoints) << "none is left";
}

TEST(Project, JointsMoveInTheScanFrameOnly) {
  KeypointSet body;
  body.frame = KeypointFrame::body;
  body.joints = {{"head", {}}};
  const std::vector<Edit> edits = {{KeypointsEdit{body}, ""},
                                   {JointsEdit{{{"neck", KeypointSet::Joint{}}}}, ""}};
  EXPECT_THROW(with_edits({}, edits), Error);
}

TEST(Project, ThreadsAreTheMachinesOwn) {
  Project project = sample_project();
  project.settings.threads = 7;
  EXPECT_EQ(parse_project(project_json(project), "p.json").settings.threads, 0);
}

TEST(Project, BelongsToItsScanAndModel) {
  const Project project = sample_project();
  Scan scan;
  scan.file_name = "other.ply";
  scan.sha256 = project.scan_sha256;
  check_scan(project, scan);
  scan.sha256[3] = 'c';
  const auto said = [&](const auto& check) -> std::string {
    try {
      check();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      return error.what();
    }
    return "";
  };
  const std::string about_scan = said([&] { check_scan(project, scan); });
  EXPECT_NE(about_scan.find("other.ply"), std::string::npos);
  EXPECT_NE(about_scan.find(project.scan_file), std::string::npos);
  BodyModel model;
  model.sha256 = project.model_sha256;
  check_model(project, model);
  model.sha256[0] = 'x';
  EXPECT_NE(said([&] { check_model(project, model); }).find("--model"), std::string::npos);
}

TEST(Project, BrokenFilesNameThePlace) {
  const std::string good = project_json(sample_project());
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string text = good;
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "line 1"},
      {"[]", "an object"},
      {with("\"vitruvian_project\": 1", "\"vitruvian_project\": 2"), "newer"},
      {with("\"sha256\"", "\"sha\""), "scan"},
      {with("\"edit\": \"crop\"", "\"edit\": \"cut\""), "edits[0].edit"},
      {with("\"head\": ", "\"skull\": "), "skull"},
      {with("\"edit\": \"joints\"", "\"edit\": \"regions\""), "edits[3]"},
      {with("\"views\": 2", "\"views\": -2"), "settings.views"},
      {good.substr(0, good.size() / 2), "JSON"},
  };
  for (const auto& [text, place] : cases) {
    try {
      parse_project(text, "p.json");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_file);
      EXPECT_NE(std::string(error.what()).find("p.json"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(place), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace vitruvian
