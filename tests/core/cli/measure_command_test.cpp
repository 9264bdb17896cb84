#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "body/forward.h"
#include "cli/wiring.h"
#include "core/cli/cli_fixture.h"
#include "pipeline/report.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using nlohmann::json;

class MeasureCommand : public CliTest {
 protected:
  MeasureCommand() {
    const char* data = std::getenv("VITRUVIAN_DATA");
    open_body_ = native_body({data ? data : VITRUVIAN_MODELS_DIR});
  }

  /// A registration of the default body at rest, with the given shape.
  std::string write_registration(double first_beta = 0) {
    const BodyModel body = open_body_("", "");
    Registration r = sample_registration();
    r.model.name = body.name;
    r.model.sha256 = body.sha256;
    const BodyState state = BodyState::rest(body);
    r.parameters = BodyParameters{state.betas, Points3d::Zero(3, body.joint_count()), Vec3d::Zero()};
    r.parameters->betas[0] = first_beta;
    return write("registration.json", registration_json(r, "1", JsonStyle::pretty));
  }
};

TEST_F(MeasureCommand, WritesBothFiles) {
  const std::string registration = write_registration(1);
  ASSERT_EQ(run({"measure", registration, "--out", path("m"), "--section", "left_arm:t=0.5", "--profile",
                 "head:4"}),
            0)
      << error();
  const json result = json::parse(read("m/measurements.json"));
  double sum = 0;
  for (const json& segment : result["segments"]) {
    sum += segment["volume_closed_cm3"].get<double>();
    EXPECT_GT(segment["volume_hull_cm3"], 0);
    EXPECT_EQ(segment["com_m"].size(), 3u);
  }
  EXPECT_EQ(result["segments"].size(), 24u);
  EXPECT_NEAR(sum / result["body"]["volume_cm3"].get<double>(), 1, 1e-6);
  ASSERT_EQ(result["sections"].size(), 5u);
  EXPECT_EQ(result["sections"][0]["segment"], "left_arm");
  EXPECT_GT(result["sections"][0]["perimeter_mm"], result["sections"][0]["breadth_mm"]);
  EXPECT_EQ(read("m/measurements.csv").find("id,name,standard,side,value,unit,uncertainty\n"), 0u);
  EXPECT_EQ(result["registration_sha256"].get<std::string>().size(), 64u);
  const std::string first = read("m/measurements.json");
  EXPECT_EQ(run({"measure", registration, "--section", "left_arm:t=0.5", "--profile", "head:4"}), 0);
  EXPECT_EQ(out(), first) << "without --out the JSON goes to stdout";
}

TEST_F(MeasureCommand, WritesDimensionsLandmarksAndExports) {
  const std::string registration = write_registration(-1);
  ASSERT_EQ(run({"measure", registration, "--out", path("m"), "--export",
                 "glb,npz,smpl,trc,landmarks,ply,obj,html"}),
            0)
      << error();
  const json result = json::parse(read("m/measurements.json"));
  EXPECT_GT(result["dimensions"].size(), 100u);
  EXPECT_GE(result["landmarks"].size(), 70u);
  for (const json& row : result["dimensions"]) {
    EXPECT_TRUE(row["posture"] == "standard" || row["posture"] == "scanned");
    EXPECT_EQ(row["posture"] == "scanned", row["figure"] == "scanned");
    EXPECT_GT(row["value_mm"], 0);
    EXPECT_GT(row["uncertainty_mm"], 0);
  }
  // Every row of the tidy table has seven fields, commas in quotes not counted, and an id of its own.
  std::istringstream table(read("m/measurements.csv"));
  std::set<std::string> ids;
  for (std::string line; std::getline(table, line);) {
    int fields = 1;
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted) ++fields;
    }
    EXPECT_EQ(fields, 7) << line;
    EXPECT_TRUE(ids.insert(line.substr(0, line.find(','))).second) << line;
  }
  for (const char* name : {"body.glb", "amass.npz", "body.smpl", "markers.trc", "markers_subject.json",
                           "landmarks.csv", "segments.ply", "segments.obj", "report.html"}) {
    EXPECT_GT(read(std::string("m/") + name).size(), 30u) << name;
  }
  EXPECT_FALSE(exists("m/errors.ply")) << "no scan, no errors";
  EXPECT_EQ(run({"measure", registration, "--export", "glb"}), 2) << "needs --out";
  EXPECT_EQ(run({"measure", registration, "--out", path("m"), "--export", "fbx"}), 2);
  EXPECT_EQ(run({"measure", registration, "--scan", write_scan("other.ply")}), 2) << "not the scan";
  EXPECT_TRUE(said("sha256"));
  EXPECT_EQ(run({"measure", registration, "--scan", path("none.ply")}), 3);
}

TEST_F(MeasureCommand, VertexOffsetsCount) {
  const BodyModel body = open_body_("", "");
  Registration r =
      parse_registration(read(std::filesystem::path(write_registration()).filename().string()), "r");
  r.parameters->offsets_file = "offsets.npz";
  // Everything 2 % larger in depth.
  const Points3f offsets = Eigen::Vector3f(0, 0, 0.02f).asDiagonal() * body.v_template;
  write("d/offsets.npz", offsets_npz(offsets));
  const std::string detailed = write("d/registration.json", registration_json(r, "1", JsonStyle::pretty));
  ASSERT_EQ(run({"measure", detailed}), 0) << error();
  const double larger = json::parse(out())["body"]["volume_cm3"];
  ASSERT_EQ(run({"measure", path("registration.json")}), 0);
  EXPECT_NEAR(larger / json::parse(out())["body"]["volume_cm3"].get<double>(), 1.02, 1e-4);
  write("d/offsets.npz", offsets_npz(offsets.leftCols(9)));
  EXPECT_EQ(run({"measure", detailed}), 3);
  r.parameters->offsets_file = "../offsets.npz";
  EXPECT_EQ(run({"measure", write("d/registration.json", registration_json(r, "1", JsonStyle::pretty))}), 3);
}

TEST_F(MeasureCommand, RefusesWhatItCannotMeasure) {
  const std::string registration = write_registration();
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"nose:t=0.5", "no segment"},   {"left_arm", ":t=F"},           {"left_arm:t=1.5", "0 to 1"},
      {"left_arm:t=x", "no number"},  {"left_arm:d=-1", "negative"},  {"left_arm:d=9e9", "beyond"},
      {"left_arm:d=1@top", "distal"}, {"left_arm:t=nan", "no number"}};
  for (const auto& [section, message] : wrong) {
    EXPECT_EQ(run({"measure", registration, "--section", section}), 2) << section;
    EXPECT_TRUE(said(message)) << section << ": " << error();
  }
  for (const std::string profile : {"left_arm:1", "left_arm:2.5", "left_arm", "left_arm:1e9", ":5"}) {
    EXPECT_EQ(run({"measure", registration, "--profile", profile}), 2) << profile;
  }
  EXPECT_EQ(run({"measure", path("missing.json")}), 3);
  EXPECT_EQ(run({"measure", write("broken.json", "{")}), 3);
  Registration failed;
  EXPECT_EQ(run({"measure", write("failed.json", registration_json(failed, "1", JsonStyle::compact))}), 1);
  EXPECT_EQ(run({"measure",
                 write("other.json", registration_json(sample_registration(), "1", JsonStyle::compact))}),
            2);
  EXPECT_TRUE(said("--model")) << error();
  EXPECT_EQ(run({"measure", registration, "--model", path("none.vbm")}), 2);
}

}  // namespace
}  // namespace vitruvian
