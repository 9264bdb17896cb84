#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/cli/cli_fixture.h"
#include "io/npz.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using nlohmann::json;

class RegisterCommand : public CliTest {
 protected:
  std::vector<json> out_lines() const {
    std::vector<json> lines;
    std::istringstream text(out());
    for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
    return lines;
  }
  void verdict_is(VerdictStatus status) {
    register_ = [status](const Scan& scan, const Settings& settings, const Execution&) {
      Registration r = pretended(scan, settings);
      r.verdict.status = status;
      return r;
    };
  }
};

TEST_F(RegisterCommand, OkScanGivesStatus0AndThreeFiles) {
  const std::string scan = write_scan("body.ply");
  EXPECT_EQ(run({"register", scan, "--out", path("deep/out")}), 0) << error();
  const json result = json::parse(read("deep/out/body/registration.json"));
  EXPECT_EQ(result["scan"]["file"], "body.ply");
  EXPECT_EQ(result["scan"]["vertices"], 4);
  EXPECT_EQ(result["vitruvian"], VITRUVIAN_VERSION);
  EXPECT_EQ(read("deep/out/body/registered.ply").substr(0, 4), "ply\n");
  EXPECT_NE(read("deep/out/body/registered.ply").find("error_mm"), std::string::npos);
  EXPECT_EQ(read("deep/out/body/errors.csv").rfind("segment,observed", 0), 0u);
  EXPECT_NE(out().find("Verdict  ok"), std::string::npos) << "a single scan gets its report";
  EXPECT_TRUE(said("read")) << "progress goes to stderr";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("deep/out/body")), {}), 3)
      << "no temporary file";
}

TEST_F(RegisterCommand, VertexOffsetsAreWrittenBesideTheJson) {
  Points3f given;
  register_ = [&](const Scan& scan, const Settings& settings, const Execution&) {
    EXPECT_EQ(settings.detail, DetailMode::vertex);
    Registration r = pretended(scan, settings);
    r.offsets = given = 0.001f * scan.vertices;
    r.parameters->offsets_file = kOffsetsFile;
    return r;
  };
  EXPECT_EQ(run({"register", write_scan("body.ply"), "--out", path("out"), "--detail", "vertex"}), 0);
  const std::string file = read("out/body/offsets.npz");
  const NumericArray offsets =
      NpzFile(std::as_bytes(std::span(std::string_view(file))), "offsets.npz").array("offsets");
  EXPECT_EQ(offsets.shape, (std::vector<std::size_t>{4, 3}));
  for (int i = 0; i < 12; ++i) EXPECT_EQ(offsets.values[i], given(i % 3, i / 3)) << "vertex by vertex";
  const json result = json::parse(read("out/body/registration.json"));
  EXPECT_EQ(result["parameters"]["offsets"], "offsets.npz");
  EXPECT_EQ(result["settings"]["detail"], "vertex");
}

TEST_F(RegisterCommand, FormatsAndStaleOutputs) {
  const std::string scan = write_scan("body.ply");
  write("out/body/offsets.npz", "old");
  EXPECT_EQ(run({"register", scan, "--out", path("out"), "--format", "obj"}), 0);
  EXPECT_TRUE(exists("out/body/registered.obj"));
  EXPECT_FALSE(exists("out/body/offsets.npz"));
  EXPECT_EQ(run({"register", scan, "--out", path("out"), "--format", "glb"}), 0);
  EXPECT_EQ(read("out/body/registered.glb").substr(0, 4), "glTF");
  EXPECT_FALSE(exists("out/body/registered.obj")) << "of the earlier run";
}

TEST_F(RegisterCommand, DoubtfulScanGivesStatus1AndItsMesh) {
  verdict_is(VerdictStatus::doubtful);
  EXPECT_EQ(run({"register", write_scan("a.ply"), "--out", path("out")}), 1);
  EXPECT_TRUE(exists("out/a/registered.ply"));
}

TEST_F(RegisterCommand, FailedScanGivesStatus1ItsJsonAndNothingElse) {
  const std::string scan = write_scan("a.ply");
  EXPECT_EQ(run({"register", scan, "--out", path("out")}), 0);
  register_ = [](const Scan& s, const Settings& settings, const Execution&) {
    Registration r;
    r.scan.file = s.file_name;
    r.settings = settings;
    r.verdict = {VerdictStatus::failed, 0, {"no body was found"}};
    return r;
  };
  EXPECT_EQ(run({"register", scan, "--out", path("out")}), 1);
  EXPECT_FALSE(exists("out/a/registered.ply"));
  EXPECT_FALSE(exists("out/a/errors.csv"));
  const json result = json::parse(read("out/a/registration.json"));
  EXPECT_EQ(result["verdict"]["status"], "failed");
  EXPECT_TRUE(result["parameters"].is_null());
  verdict_is(VerdictStatus::failed);
  EXPECT_EQ(run({"register", scan, "--out", path("out")}), 1);
  EXPECT_FALSE(exists("out/a/registered.ply")) << "a mesh that is known to be wrong is not written";
}

TEST_F(RegisterCommand, UnreadableScansGiveStatus3) {
  EXPECT_EQ(run({"register", path("missing.ply"), "--out", path("out")}), 3);
  EXPECT_TRUE(said("missing.ply"));
  EXPECT_EQ(run({"register", write("broken.ply", "ply\nformat ascii 1.0\nelement vertex 5\n"), "--out",
                 path("out")}),
            3);
  EXPECT_TRUE(said("broken.ply"));
  EXPECT_EQ(run({"register", write("empty.ply", ""), "--out", path("out")}), 3);
  std::filesystem::create_directories(path("folder.ply"));
  EXPECT_EQ(run({"register", path("folder.ply"), "--out", path("out")}), 3);
  EXPECT_FALSE(exists("out/missing/registration.json"));
}

TEST_F(RegisterCommand, ScanThatCannotBeReadAnyMoreLosesItsEarlierResult) {
  const std::string scan = write_scan("a.ply");
  EXPECT_EQ(run({"register", scan, "--out", path("out")}), 0);
  write("a.ply", "damaged");
  EXPECT_EQ(run({"register", scan, "--out", path("out")}), 3);
  EXPECT_FALSE(exists("out/a/registration.json"));
  EXPECT_FALSE(exists("out/a/registered.ply"));
}

TEST_F(RegisterCommand, WrongUsageGivesStatus2BeforeAnyWork) {
  const std::string scan = write_scan("a.ply"), twin = write_scan("other/a.ply");
  bool opened = false;
  open_ = [&](const RegisterArguments&) -> RegisterFunction {
    opened = true;
    return {};
  };
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"register", scan, twin, "--out", path("out")},
                                             {"register", scan, scan, "--out", path("out")},
                                             {"register", scan},
                                             {"register", "--out", path("out")},
                                             {"register", scan, "--out", path("out"), "--up", "w"},
                                             {"register", scan, "--out", path("out"), "--crop", "c.json"},
                                             {"register", scan, "--out", path("out"), "--iterations", "9"},
                                             {"register", path(""), "--out", path("out")},
                                             {"measure"},
                                             {"nonsense"},
                                             {}}) {
    EXPECT_EQ(run(arguments), 2);
    EXPECT_TRUE(said("vitruvian: "));
    EXPECT_EQ(out(), "");
  }
  EXPECT_FALSE(opened);
  EXPECT_FALSE(exists("out"));
  run({"register", scan, "--out", path("out"), "--crop", "c.json"});
  EXPECT_TRUE(said("c.json: cannot be read")) << error();
}

TEST_F(RegisterCommand, UnusableModelGivesStatus2) {
  open_ = [](const RegisterArguments&) -> RegisterFunction {
    throw Error(ErrorCode::bad_model, "m.vbm: no model");
  };
  EXPECT_EQ(run({"register", write_scan("a.ply"), "--out", path("out"), "--model", "m.vbm"}), 2);
  EXPECT_TRUE(said("m.vbm: no model"));
}

TEST_F(RegisterCommand, FilesOfEditsReachTheRegistrationAndItsJson) {
  const std::string scan = write_scan("a.ply");
  ASSERT_EQ(run({"register", scan, "--out", path("first")}), 0) << error();
  const std::string keypoints =
      write("k.json",
            R"({"frame": "canonical", "joints": {"head": {"position": [0, 0, 1.7]}, "neck": {"position":
               [0, 0, 1.5], "confidence": 0.5}, "pelvis": {"position": [0, 0, 1]}}})");
  const std::string alignment =
      write("m.json", "[[0.001, 0, 0, 1], [0, 0, 0.001, 2], [0, -0.001, 0, 3], [0, 0, 0, 1]]");
  Settings seen;
  register_ = [&](const Scan& s, const Settings& settings, const Execution&) {
    seen = settings;
    return pretended(s, settings);
  };
  ASSERT_EQ(
      run({"register", scan, "--out", path("out"), "--keypoints", keypoints, "--align-file", alignment}), 0)
      << error();
  ASSERT_TRUE(seen.keypoints && seen.body_from_scan);
  EXPECT_EQ(seen.keypoints->frame, KeypointFrame::canonical);
  EXPECT_EQ(seen.keypoints->joints.at("neck").confidence, 0.5);
  EXPECT_EQ((*seen.body_from_scan)(2, 1), -0.001);
  json settings = json::parse(read("out/a/registration.json"))["settings"];
  EXPECT_EQ(settings["keypoints"]["joints"]["head"]["position"], json({0, 0, 1.7}));
  EXPECT_EQ(settings["body_from_scan"][1][3], 2);

  ASSERT_EQ(run({"register", scan, "--out", path("out"), "--init", path("first/a/registration.json")}), 0)
      << error();
  EXPECT_EQ(seen.init, InitMode::file);
  ASSERT_TRUE(seen.start);
  EXPECT_EQ(seen.start->parameters.pose, sample_registration().parameters->pose);
  EXPECT_EQ(seen.start->model_sha256, sample_registration().model.sha256);
  settings = json::parse(read("out/a/registration.json"))["settings"];
  EXPECT_EQ(settings["init"], "file");
  EXPECT_EQ(settings["start"]["betas"].size(), 32u);
}

TEST_F(RegisterCommand, ProjectIsReplayedOnItsOwnScanOnly) {
  const std::string scan = write_scan("a.ply");
  const std::string crops =
      write("c.json", R"({"crops": [{"remove": "inside", "box": {"min": [5, 5, 5], "max": [6, 6, 6]}}]})");
  ASSERT_EQ(run({"register", scan, "--out", path("first"), "--crop", crops, "--views", "2"}), 0) << error();
  const json first = json::parse(read("first/a/registration.json"));
  ASSERT_EQ(first["settings"]["crops"].size(), 1u);
  json project = {{"vitruvian_project", 1},
                  {"scan", {{"file", "a.ply"}, {"sha256", first["scan"]["sha256"]}}},
                  {"settings", first["settings"]},
                  {"edits", {{{"edit", "keypoints"}, {"keypoints", nullptr}}}}};
  const std::string file = write("p.json", project.dump());
  ASSERT_EQ(run({"register", scan, "--out", path("out"), "--project", file}), 0) << error();
  EXPECT_EQ(json::parse(read("out/a/registration.json"))["settings"], first["settings"]);

  const std::string twin = write("twin.ply", read("a.ply") + "\n");
  EXPECT_EQ(run({"register", twin, "--out", path("out"), "--project", file}), 2);
  EXPECT_TRUE(said("another scan (a.ply)")) << error();
  EXPECT_EQ(run({"register", scan, "--out", path("out"), "--project", file, "--views", "2"}), 2);
  EXPECT_TRUE(said("--views")) << error();
  EXPECT_EQ(run({"register", scan, twin, "--out", path("out"), "--project", file}), 2);
  EXPECT_TRUE(said("one scan")) << error();
}

TEST_F(RegisterCommand, UnusableFilesOfEditsGiveStatus2AndNameThePlace) {
  const std::string scan = write_scan("a.ply");
  ASSERT_EQ(run({"register", scan, "--out", path("first")}), 0);
  json failed = json::parse(read("first/a/registration.json"));
  failed["parameters"] = nullptr;
  const struct {
    std::string option, text, said;
  } cases[] = {
      {"--keypoints", "{", "line 1"},
      {"--keypoints", R"({"frame": "world", "joints": {}})", "frame: one of scan body canonical"},
      {"--keypoints", R"({"frame": "scan", "joints": {"nose": {"position": [0, 0, 0]}}})", "joints.nose"},
      {"--keypoints", R"({"frame": "scan", "joints": {"head": {"position": [0, 0]}}})",
       "joints.head.position"},
      {"--keypoints", R"({"frame": "scan", "joints": {"head": {"position": [0, 0, 1e999]}}})", "1e999"},
      {"--align-file", "[[1, 0, 0, 0]]", "four rows"},
      {"--align-file", "[[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]", "determinant"},
      {"--crop", R"({"crops": []})", "there is no crop"},
      {"--project", R"({"vitruvian_project": 9})", "newer"},
      {"--init", "{}", "registration.json"},
      {"--init", failed.dump(), "parameters"},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.option + " " + c.text.substr(0, 60));
    EXPECT_EQ(run({"register", scan, "--out", path("out"), c.option, write("edit.json", c.text)}), 2);
    EXPECT_TRUE(said("edit.json")) << error();
    EXPECT_TRUE(said(c.said)) << error();
  }
  EXPECT_EQ(run({"register", scan, "--out", path("out"), "--init", path("missing.json")}), 2);
  EXPECT_TRUE(said("missing.json"));
  EXPECT_FALSE(exists("out"));
}

TEST_F(RegisterCommand, SettingsThatTheRegistrationRefusesGiveStatus2) {
  register_ = [](const Scan&, const Settings&, const Execution&) -> Registration {
    throw Error(ErrorCode::usage, "--front lies along --up");
  };
  EXPECT_EQ(run({"register", write_scan("a.ply"), write_scan("b.ply"), "--out", path("out")}), 2);
  EXPECT_TRUE(said("--front lies along --up"));
}

TEST_F(RegisterCommand, UnwritableOutputGivesStatus4) {
  const std::string scan = write_scan("a.ply");
  EXPECT_EQ(run({"register", scan, "--out", path("a.ply/out")}), 4);
  EXPECT_TRUE(said("a.ply/out")) << error();
  write("out/a", "a file where the folder should be");
  EXPECT_EQ(run({"register", scan, write_scan("b.ply"), "--out", path("out")}), 4);
  EXPECT_TRUE(exists("out/b/registration.json")) << "the batch goes on";
  EXPECT_EQ(read("out/a"), "a file where the folder should be");
}

TEST_F(RegisterCommand, OutputThatCannotBeReplacedLeavesNoHalfResult) {
  std::filesystem::create_directories(path("out/a/registered.ply/x"));
  EXPECT_EQ(run({"register", write_scan("a.ply"), "--out", path("out")}), 4);
  EXPECT_FALSE(exists("out/a/registration.json"));
}

TEST_F(RegisterCommand, InternalErrorsGiveStatus4AndTheBatchGoesOn) {
  register_ = [](const Scan& scan, const Settings& settings, const Execution&) {
    if (scan.file_name == "a.ply") throw std::runtime_error("boom");
    if (scan.file_name == "b.ply") throw Error(ErrorCode::internal, "broken invariant");
    return pretended(scan, settings);
  };
  EXPECT_EQ(run({"register", write_scan("a.ply"), write_scan("b.ply"), write_scan("c.ply"), "--out",
                 path("out"), "--json"}),
            4);
  const std::vector<json> lines = out_lines();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0]["error"]["code"], "internal");
  EXPECT_NE(lines[0]["error"]["message"].get<std::string>().find("boom"), std::string::npos);
  EXPECT_EQ(lines[2]["verdict"]["status"], "ok");
}

TEST_F(RegisterCommand, TheHighestOf431Wins) {
  const std::string good = write_scan("good.ply"), broken = write("broken.ply", "ply\n");
  register_ = [](const Scan& scan, const Settings& settings, const Execution&) {
    if (scan.file_name == "crash.ply") throw std::runtime_error("boom");
    Registration r = pretended(scan, settings);
    if (scan.file_name == "doubt.ply") r.verdict.status = VerdictStatus::doubtful;
    return r;
  };
  const std::string doubt = write_scan("doubt.ply"), crash = write_scan("crash.ply");
  EXPECT_EQ(run({"register", good, doubt, "--out", path("out")}), 1);
  EXPECT_EQ(run({"register", broken, good, doubt, "--out", path("out")}), 3);
  EXPECT_EQ(run({"register", crash, broken, doubt, good, "--out", path("out")}), 4);
}

TEST_F(RegisterCommand, BatchGoesOnAfterABrokenScanAndEndsWithATable) {
  const std::string a = write_scan("a.ply"), broken = write("broken.ply", "ply\n"), c = write_scan("c.ply");
  EXPECT_EQ(run({"register", a, broken, c, "--out", path("out")}), 3);
  EXPECT_TRUE(exists("out/a/registration.json"));
  EXPECT_TRUE(exists("out/c/registration.json"));
  const std::string table = out();
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << table;
  EXPECT_EQ(table.rfind("scan ", 0), 0u);
  EXPECT_NE(table.find("error"), std::string::npos);
}

TEST_F(RegisterCommand, JsonIsOneLineAScanOnStdoutAndTheTableGoesToStderr) {
  const std::string a = write_scan("a.ply"), broken = write("broken.ply", "ply\n");
  EXPECT_EQ(run({"register", a, broken, "--out", path("out"), "--json"}), 3);
  const std::vector<json> lines = out_lines();
  ASSERT_EQ(lines.size(), 2u) << out();
  EXPECT_EQ(lines[0], json::parse(read("out/a/registration.json"))) << "the whole registration.json";
  EXPECT_EQ(lines[1]["scan"], broken);
  EXPECT_EQ(lines[1]["error"]["code"], "bad_file");
  EXPECT_NE(lines[1]["error"]["message"].get<std::string>().find("broken.ply"), std::string::npos);
  EXPECT_TRUE(said("verdict"));
}

TEST_F(RegisterCommand, QuietSaysNothingButErrors) {
  const std::string a = write_scan("a.ply");
  EXPECT_EQ(run({"register", a, write_scan("b.ply"), "--out", path("out"), "--quiet"}), 0);
  EXPECT_EQ(out() + error(), "");
  EXPECT_EQ(run({"register", path("missing.ply"), "--out", path("out"), "--quiet"}), 3);
  EXPECT_EQ(out(), "");
  EXPECT_TRUE(said("missing.ply"));
  EXPECT_EQ(run({"register", a, "--out", path("out"), "--quiet", "--json"}), 0);
  EXPECT_EQ(out_lines().size(), 1u);
}

TEST_F(RegisterCommand, InterruptGives130AndWritesNothingMore) {
  const std::string a = write_scan("a.ply"), b = write_scan("b.ply"), c = write_scan("c.ply");
  register_ = [this](const Scan& scan, const Settings& settings, const Execution& execution) {
    if (scan.file_name == "b.ply") interrupt_.cancel();
    execution.check();
    return pretended(scan, settings);
  };
  EXPECT_EQ(run({"register", a, b, c, "--out", path("out")}), 130);
  EXPECT_TRUE(exists("out/a/registration.json"));
  EXPECT_FALSE(exists("out/b"));
  EXPECT_FALSE(exists("out/c"));
}

TEST_F(RegisterCommand, InterruptThatTheRegistrationOverlooksCountsBeforeWriting) {
  register_ = [this](const Scan& scan, const Settings& settings, const Execution&) {
    interrupt_.cancel();
    return pretended(scan, settings);
  };
  EXPECT_EQ(run({"register", write_scan("a.ply"), "--out", path("out")}), 130);
  EXPECT_FALSE(exists("out/a/registration.json"));
}

TEST_F(RegisterCommand, TheRegistrationSeesTheSettingsAndEveryThread) {
  Settings seen;
  int threads = 0;
  register_ = [&](const Scan& scan, const Settings& settings, const Execution& execution) {
    seen = settings;
    threads = execution.threads();
    return pretended(scan, settings);
  };
  EXPECT_EQ(run({"register", write_scan("a.ply"), "--out", path("out"), "--up", "-z", "--seed", "7",
                 "--threads", "3"}),
            0);
  EXPECT_EQ(seen.up, Axis::minus_z);
  EXPECT_EQ(seen.seed, 7u);
  EXPECT_EQ(threads, 3);
  const json result = json::parse(read("out/a/registration.json"));
  EXPECT_EQ(result["settings"]["threads"], 3);
  EXPECT_EQ(run({"register", path("a.ply"), "--out", path("out")}), 0);
  EXPECT_GE(seen.threads, 1) << "what was used is recorded, not 'all'";
}

TEST_F(RegisterCommand, UnicodeNamesWork) {
  EXPECT_EQ(run({"register", write_scan("J\xc3\xb6rg \xe4\xba\xba.ply"), "--out", path("\xc3\xa4us")}), 0)
      << error();
  EXPECT_TRUE(exists("\xc3\xa4us/J\xc3\xb6rg \xe4\xba\xba/registration.json"));
}

TEST_F(RegisterCommand, NamesThatAreNoUtf8DoNotBreakTheJson) {
  EXPECT_EQ(run({"register", path("bad\xff.ply"), "--out", path("out"), "--json"}), 3);
  EXPECT_EQ(out_lines().size(), 1u);
}

TEST_F(RegisterCommand, BarOnATerminalOnly) {
  const std::string a = write_scan("a.ply");
  EXPECT_EQ(run({"register", a, "--out", path("out")}, true), 0);
  EXPECT_TRUE(said("\r\x1b[K"));
  EXPECT_EQ(run({"register", a, "--out", path("out")}, false), 0);
  EXPECT_FALSE(said("\x1b"));
}

}  // namespace
}  // namespace vitruvian
