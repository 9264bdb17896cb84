#include "pipeline/result_json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/random.h"
#include "core/pipeline/sample_registration.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

std::vector<std::string> keys(const ordered_json& object) {
  std::vector<std::string> result;
  for (const auto& [key, value] : object.items()) result.push_back(key);
  return result;
}
using Keys = std::vector<std::string>;

ordered_json written(const Registration& registration) {
  return ordered_json::parse(registration_json(registration, "9.8.7", JsonStyle::pretty));
}

TEST(ResultJson, HasTheContractsKeysInItsOrder) {
  const ordered_json j = written(sample_registration());
  EXPECT_EQ(keys(j), (Keys{"vitruvian", "scan", "model", "alignment", "keypoints", "parameters", "joints",
                           "surface_error", "verdict", "timing_ms", "settings"}));
  EXPECT_EQ(j["vitruvian"], "9.8.7");
  EXPECT_EQ(keys(j["scan"]), (Keys{"file", "sha256", "vertices", "faces", "unit", "metres_per_unit"}));
  EXPECT_EQ(keys(j["model"]),
            (Keys{"name", "family", "gender", "vertices", "faces", "betas", "joints", "sha256"}));
  EXPECT_EQ(keys(j["alignment"]), (Keys{"body_from_scan", "canonical_from_body", "up", "front", "method"}));
  ASSERT_EQ(j["keypoints"].size(), 22u);
  EXPECT_EQ(keys(j["keypoints"][0]), (Keys{"joint", "position_m", "confidence", "source"}));
  EXPECT_EQ(keys(j["parameters"]), (Keys{"betas", "pose", "translation_m"}));
  ASSERT_EQ(j["joints"].size(), 24u);
  EXPECT_EQ(keys(j["joints"][3]), (Keys{"name", "body_m", "scan"}));
  EXPECT_EQ(keys(j["surface_error"]),
            (Keys{"segments", "all", "surface_segments", "surface_all", "scan_to_model"}));
  for (const char* table : {"segments", "surface_segments"}) {
    ASSERT_EQ(j["surface_error"][table].size(), 24u);
    EXPECT_EQ(keys(j["surface_error"][table][5]),
              (Keys{"segment", "observed", "count", "mean_mm", "std_mm", "median_mm", "p95_mm", "max_mm"}));
  }
  EXPECT_EQ(keys(j["surface_error"]["scan_to_model"]), (Keys{"mean_mm", "median_mm", "p95_mm", "max_mm"}));
  EXPECT_EQ(keys(j["verdict"]), (Keys{"status", "confidence", "reasons"}));
  EXPECT_EQ(keys(j["timing_ms"]), (Keys{"read", "align", "project", "detect", "pose", "fit", "refine",
                                        "detail", "write", "total"}));
  EXPECT_EQ(keys(j["settings"]), (Keys{"method", "align", "views", "min_visibility", "init", "solver",
                                       "iterations", "adam_iterations", "one_directional", "chunk", "gender",
                                       "betas", "units", "up", "front", "detail", "threads", "seed"}));
}

TEST(ResultJson, EditsAreKeptWithAllTheirNumbers) {
  Registration r = sample_registration();
  r.settings.body_from_scan = r.alignment.body_from_scan;
  r.settings.keypoints = KeypointSet{KeypointFrame::body,
                                     {{"head", {Vec3d(1.0 / 3, 2, 3), 0.25}}, {"neck", {}}, {"pelvis", {}}}};
  r.settings.init = InitMode::file;
  r.settings.start = StartBody{*r.parameters, "abc"};
  for (const JsonStyle style : {JsonStyle::compact, JsonStyle::pretty}) {
    const Settings back = parse_registration(registration_json(r, "1", style), "r.json").settings;
    EXPECT_EQ(back.body_from_scan, r.settings.body_from_scan);
    ASSERT_TRUE(back.keypoints && back.start);
    EXPECT_EQ(back.keypoints->frame, KeypointFrame::body);
    ASSERT_EQ(back.keypoints->joints.size(), 3u);
    EXPECT_EQ(back.keypoints->joints.at("head").position, Vec3d(1.0 / 3, 2, 3));
    EXPECT_EQ(back.keypoints->joints.at("head").confidence, 0.25);
    EXPECT_EQ(back.start->parameters.betas, r.parameters->betas);
    EXPECT_EQ(back.start->parameters.pose, r.parameters->pose);
    EXPECT_EQ(back.start->parameters.translation_m, r.parameters->translation_m);
    EXPECT_EQ(back.start->model_sha256, "abc");
  }
  r.settings.regions = RegionSet{"s", "m", {{"left hand", {3, 1}, {2}}, {"feet", {0}, {5, 4}}}};
  const Settings painted =
      parse_registration(registration_json(r, "1", JsonStyle::pretty), "r.json").settings;
  ASSERT_TRUE(painted.regions);
  EXPECT_EQ(painted.regions->scan_sha256, "s");
  ASSERT_EQ(painted.regions->pairs.size(), 2u);
  EXPECT_EQ(painted.regions->pairs[0].scan_vertices, (std::vector<int>{3, 1}));
  EXPECT_EQ(painted.regions->pairs[1].template_vertices, (std::vector<int>{5, 4}));
  EXPECT_EQ(painted.regions->pairs[1].name, "feet");
  r.settings.start.reset();
  EXPECT_THROW(parse_registration(registration_json(r, "1", JsonStyle::compact), "r.json"), Error);
}

TEST(ResultJson, ValuesStandWhereTheyBelong) {
  const Registration r = sample_registration();
  const ordered_json j = written(r);
  EXPECT_EQ(j["scan"]["file"], r.scan.file);
  EXPECT_EQ(j["scan"]["unit"], "mm");
  ASSERT_EQ(j["alignment"]["body_from_scan"].size(), 4u);
  EXPECT_EQ(j["alignment"]["body_from_scan"][2][3], 0.25) << "rows, not columns";
  EXPECT_TRUE(j["keypoints"][15]["position_m"].is_null());
  ASSERT_EQ(j["parameters"]["pose"].size(), 72u);
  EXPECT_EQ(j["parameters"]["pose"][5], r.parameters->pose(2, 1)) << "joint by joint";
  EXPECT_EQ(j["parameters"]["translation_m"][1], -1.0 / 3) << "all digits";
  EXPECT_TRUE(j["surface_error"]["segments"][22]["mean_mm"].is_null());
  EXPECT_TRUE(j["surface_error"]["segments"][22]["count"].is_null());
  EXPECT_EQ(j["surface_error"]["segments"][21]["mean_mm"], 1.5);
  EXPECT_EQ(j["surface_error"]["surface_segments"][21]["mean_mm"], 0.75);
  EXPECT_EQ(j["settings"]["up"], "-z");
  EXPECT_EQ(j["settings"]["seed"], 4294967295u);
}

TEST(ResultJson, VertexOffsetsAddTheirFileAndTheErrorBefore) {
  Registration r = sample_registration();
  r.parameters->offsets_file = kOffsetsFile;
  r.parametric_error = r.surface_error;
  r.parametric_error->surface_all.mean_mm = 7.25;
  const ordered_json j = written(r);
  EXPECT_EQ(j["parameters"]["offsets"], "offsets.npz");
  EXPECT_EQ(keys(j["surface_error"]["parametric"]),
            (Keys{"segments", "all", "surface_segments", "surface_all", "scan_to_model"}));
  EXPECT_EQ(j["surface_error"]["parametric"]["surface_all"]["mean_mm"], 7.25);
  EXPECT_EQ(j["surface_error"]["surface_all"]["mean_mm"], 1.5);
  const std::string text = registration_json(r, "1", JsonStyle::pretty);
  EXPECT_EQ(registration_json(parse_registration(text, "r.json"), "1", JsonStyle::pretty), text);
}

TEST(ResultJson, StylesHoldTheSameDocument) {
  const Registration r = sample_registration();
  const std::string compact = registration_json(r, "1", JsonStyle::compact),
                    pretty = registration_json(r, "1", JsonStyle::pretty);
  EXPECT_EQ(compact.find('\n'), std::string::npos);
  EXPECT_EQ(ordered_json::parse(compact), ordered_json::parse(pretty));
  EXPECT_EQ(pretty.back(), '\n');
  EXPECT_LT(std::count(pretty.begin(), pretty.end(), '\n'), 250) << "rows of numbers stay on one line";
}

TEST(ResultJson, ReadingBackGivesTheSameText) {
  const Registration r = sample_registration();
  const std::string text = registration_json(r, "1", JsonStyle::pretty);
  const Registration back = parse_registration(text, "registration.json");
  EXPECT_EQ(registration_json(back, "1", JsonStyle::pretty), text);
  EXPECT_EQ(back.parameters->pose, r.parameters->pose);
  EXPECT_EQ(back.parameters->betas, r.parameters->betas);
  EXPECT_EQ(back.alignment.body_from_scan, r.alignment.body_from_scan);
  EXPECT_EQ(back.joints[7].scan, r.joints[7].scan);
}

TEST(ResultJson, VerdictFeaturesAreNamedAndReadBack) {
  Registration r = sample_registration();
  VerdictFeatures f;
  f.scan_to_model_p95_mm = 12.5;
  f.part_opposed_share[21] = 0.25;
  f.limb_misfit[3] = 1.5;
  f.refits = 7;
  f.keypoint_disagreement_m = {{"left_wrist", 0.125}};
  f.stature_m = 1.75;
  r.verdict_features = f;
  const std::string text = registration_json(r, "1", JsonStyle::pretty);
  const ordered_json j = ordered_json::parse(text)["verdict"];
  EXPECT_EQ(keys(j), (Keys{"status", "confidence", "reasons", "features"}));
  EXPECT_EQ(j["features"]["scan_to_model_p95_mm"], 12.5);
  EXPECT_EQ(j["features"]["limb_misfit"]["right_foot"], 1.5);
  ASSERT_EQ(j["features"]["segments"].size(), 24u);
  EXPECT_EQ(j["features"]["segments"][21]["segment"], "right_hand");
  EXPECT_EQ(j["features"]["segments"][21]["opposed_share"], 0.25);
  EXPECT_EQ(registration_json(parse_registration(text, "r.json"), "1", JsonStyle::pretty), text);
  r.verdict_features->typical_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(parse_registration(registration_json(r, "1", JsonStyle::pretty), "r.json"));
}

TEST(ResultJson, FailedRegistrationHasNullsAndReadsBack) {
  Registration r;
  r.scan.file = "bad.ply";
  r.verdict = {VerdictStatus::failed, 0, {"no body was found"}};
  const std::string text = registration_json(r, "1", JsonStyle::compact);
  const ordered_json j = ordered_json::parse(text);
  for (const char* key : {"alignment", "parameters", "surface_error"}) EXPECT_TRUE(j[key].is_null()) << key;
  EXPECT_TRUE(j["scan"]["unit"].is_null());
  EXPECT_TRUE(j["scan"]["metres_per_unit"].is_null());
  EXPECT_TRUE(j["joints"].empty());
  const Registration back = parse_registration(text, "x");
  EXPECT_EQ(back.verdict.status, VerdictStatus::failed);
  EXPECT_FALSE(back.parameters);
}

TEST(ResultJson, WhatIsNotFiniteBecomesNull) {
  Registration r = sample_registration();
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  r.parameters->pose(0, 0) = nan;
  r.alignment.body_from_scan(0, 0) = infinity;
  r.surface_error->all.mean_mm = nan;
  r.surface_error->scan_to_model.max_mm = -infinity;
  r.verdict.confidence = nan;
  r.timing_ms.fit = nan;
  r.joints[0].scan[1] = nan;
  for (const JsonStyle style : {JsonStyle::compact, JsonStyle::pretty}) {
    const std::string text = registration_json(r, "1", style);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_EQ(text.find("inf"), std::string::npos);
    const ordered_json j = ordered_json::parse(text);
    EXPECT_TRUE(j["parameters"]["pose"][0].is_null());
    EXPECT_TRUE(j["surface_error"]["scan_to_model"]["max_mm"].is_null());
    EXPECT_TRUE(j["verdict"]["confidence"].is_null());
  }
}

TEST(ResultJson, BytesThatAreNoUtf8DoNotBreakIt) {
  Registration r = sample_registration();
  r.scan.file = "scan\xff\xfe.ply";
  EXPECT_TRUE(ordered_json::accept(registration_json(r, "1", JsonStyle::pretty)));
  EXPECT_TRUE(ordered_json::accept(error_json("a\xff", "bad_file", "x\xc3")));
}

TEST(ResultJson, ErrorLine) {
  EXPECT_EQ(error_json("a.ply", "bad_file", "a.ply: line 3: \"x\""),
            R"({"scan":"a.ply","error":{"code":"bad_file","message":"a.ply: line 3: \"x\""}})");
}

TEST(ResultJson, ComplaintsNameFileAndPlace) {
  const ordered_json good = written(sample_registration());
  const auto complaint = [](const ordered_json& j) -> std::string {
    try {
      parse_registration(j.dump(), "r.json");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_file);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(good), "");
  ordered_json j = good;
  j["joints"][3]["scan"] = {1, 2};
  EXPECT_EQ(complaint(j), "r.json: joints[3].scan: three numbers [x, y, z] are expected");
  j = good;
  j["alignment"]["body_from_scan"][1][2] = "x";
  EXPECT_EQ(complaint(j), "r.json: alignment.body_from_scan[1][2]: a number is expected");
  j = good;
  j.erase("settings");
  EXPECT_EQ(complaint(j), "r.json: \"settings\" is missing");
  // Earlier versions wrote fewer settings.
  j = good;
  j["settings"] = {{"method", "paper-cpu"}, {"chunk", 64}};
  EXPECT_EQ(complaint(j), "");
  const Settings earlier = parse_registration(j.dump(), "r.json").settings;
  EXPECT_EQ(earlier.iterations, settings_of(Method::paper_cpu).iterations);
  EXPECT_EQ(earlier.chunk, 64);
  j["settings"]["up"] = "w";
  EXPECT_NE(complaint(j).find("settings.up: one of auto x y z -x -y -z"), std::string::npos);
  EXPECT_NE(complaint(ordered_json::array()).find("no registration.json"), std::string::npos);
  try {
    parse_registration("{\n\"vitruvian\": oops}", "r.json");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("r.json: line 2"), std::string::npos) << error.what();
  }
}

TEST(ResultJson, DamagedTextGivesTypedErrorsOnly) {
  const std::string good = registration_json(sample_registration(), "1", JsonStyle::compact);
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::string text = good;
    if (seed % 3 == 0) text.resize(random.below(static_cast<std::uint32_t>(text.size())));
    for (int k = 0; k < 4 && !text.empty(); ++k) {
      text[random.below(static_cast<std::uint32_t>(text.size()))] = "0-{}[],:\"e.\xff"[random.below(12)];
    }
    try {
      parse_registration(text, "r.json");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_file);
    }
  }
}

}  // namespace
}  // namespace vitruvian
