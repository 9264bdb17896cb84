#include "pipeline/settings_json.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace vitruvian {
namespace {

Settings chosen(const std::string& text) {
  const nlohmann::json json = parse_json(text, "settings");
  return chosen_settings(JsonValue(json, "settings", ""));
}

std::string complaint(const std::string& text) {
  try {
    chosen(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    return error.what();
  }
  return "";
}

TEST(ChosenSettings, NothingChosenIsTheDefault) {
  EXPECT_EQ(chosen("{}"), Settings());
  EXPECT_EQ(chosen(R"({"method": "ours", "views": null, "keypoints": null})"), Settings());
}

TEST(ChosenSettings, AMethodStandsForItsStages) {
  EXPECT_EQ(chosen(R"({"method": "paper"})"), settings_of(Method::paper));
  EXPECT_EQ(chosen(R"({"method": "paper-cpu"})"), settings_of(Method::paper_cpu));
}

TEST(ChosenSettings, WhatIsGivenOverridesTheMethod) {
  // "align" comes before "method" in the alphabet, "views" after it: the order must not matter.
  Settings expected = settings_of(Method::paper_cpu);
  expected.align = AlignMode::automatic;
  expected.views = 8;
  expected.iterations = 70;
  expected.adam_iterations = 0;
  EXPECT_EQ(
      chosen(
          R"({"align": "auto", "method": "paper-cpu", "views": 8, "iterations": 70, "adam_iterations": 0})"),
      expected);
}

TEST(ChosenSettings, ReadsEverythingThatIsWritten) {
  Settings settings = settings_of(Method::paper);
  settings.unit = Unit::millimetre;
  settings.up = Axis::minus_z;
  settings.gender = Gender::female;
  settings.seed = 4294967295u;
  settings.body_from_scan = Mat4d::Identity();
  settings.keypoints = KeypointSet{KeypointFrame::body, {{"pelvis", {Vec3d(0, 1, 2), 0.5}}}};
  settings.regions = RegionSet{"s", "m", {{"left hand", {3, 1}, {2}}}};
  settings.init = InitMode::file;
  settings.start = StartBody{
      {Eigen::VectorXd::Ones(2), Points3d::Constant(3, 24, 0.25), Vec3d(1, 2, 3), "", {}, {}}, "abc"};
  EXPECT_EQ(chosen(settings_to_json(settings).dump()), settings);
}

TEST(ChosenSettings, AStartLeavesItsOffsetsBehind) {
  const Settings settings = chosen(R"({"init": "file", "start": {"betas": [], "pose": [0, 0, 0],
      "translation_m": [0, 0, 0], "offsets": "offsets.npz", "model_sha256": "abc"}})");
  EXPECT_EQ(settings.start->parameters.offsets_file, "");
}

TEST(ChosenSettings, ComplaintsNameThePlace) {
  EXPECT_EQ(complaint(R"({"unit": "mm"})"), "settings: unit: there is no setting of this name");
  EXPECT_EQ(complaint(R"({"units": "yard"})"), "settings: units: one of auto m cm mm in is expected");
  EXPECT_NE(complaint(R"({"method": "newest"})").find("settings: method: one of"), std::string::npos);
  EXPECT_NE(complaint(R"({"iterations": 0})").find("settings: iterations:"), std::string::npos);
  EXPECT_NE(complaint(R"({"init": "file"})").find("\"start\" belongs to"), std::string::npos);
  EXPECT_NE(complaint("[1]").find("an object is expected"), std::string::npos);
}

}  // namespace
}  // namespace vitruvian
