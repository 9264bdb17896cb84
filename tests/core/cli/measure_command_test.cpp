#include <nlohmann/json.hpp>

#include "body/forward.h"
#include "cli/wiring.h"
#include "core/cli/cli_fixture.h"
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
    const BodyModel body = open_body_("");
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
