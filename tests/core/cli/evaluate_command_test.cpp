#include <nlohmann/json.hpp>

#include "core/cli/cli_fixture.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using nlohmann::json;

class EvaluateCommand : public CliTest {
 protected:
  /// A registration whose joints lie on a line, in millimetres of the scan.
  std::string write_registration() {
    Registration r = sample_registration();
    for (std::size_t j = 0; j < r.joints.size(); ++j)
      r.joints[j].scan = Vec3d(10.0 * static_cast<double>(j), 5, 0);
    return write("registration.json", registration_json(r, "1", JsonStyle::pretty));
  }
  /// The same joints shifted as a whole, one of them moved by `extra` more.
  std::string write_truth(const std::string& unit, const std::string& moved, double extra) {
    json joints;
    for (int j = 0; j < 22; ++j) {
      const std::string name(kSmplJointNames[j]);
      joints[name] = {10.0 * j + 100, 5 + (name == moved ? extra : 0), -3};
    }
    return write("truth.json", json({{"frame", "scan"}, {"unit", unit}, {"joints", joints}}).dump());
  }
};

TEST_F(EvaluateCommand, PrintsPelvisAlignedErrors) {
  const std::string registration = write_registration();
  EXPECT_EQ(run({"evaluate", registration, "--truth", write_truth("mm", "right_wrist", 42)}), 0) << error();
  json result = json::parse(out());
  EXPECT_NEAR(result["e_max_mm"], 42, 1e-3);
  EXPECT_EQ(result["worst_joint"], "right_wrist");
  EXPECT_EQ(result["joints_mm"].size(), 22u);
  EXPECT_NEAR(result["joints_mm"]["pelvis"], 0, 1e-6);
  EXPECT_NEAR(result["core_max_mm"], 42 * 11 / 12.0, 1e-3);
  EXPECT_EQ(run({"evaluate", registration, "--truth", write_truth("cm", "right_wrist", 42)}), 0);
  EXPECT_NEAR(json::parse(out())["e_max_mm"], 420, 1e-3) << "the truth's unit counts";
}

TEST_F(EvaluateCommand, Statuses) {
  const std::string registration = write_registration(), truth = write_truth("m", "", 0);
  EXPECT_EQ(run({"evaluate", registration, "--truth", path("missing.json")}), 2);
  EXPECT_EQ(run({"evaluate", registration, "--truth", write("bad.json", "{")}), 2);
  EXPECT_TRUE(said("bad.json"));
  EXPECT_EQ(run({"evaluate", path("missing.json"), "--truth", truth}), 3);
  EXPECT_EQ(run({"evaluate", truth, "--truth", truth}), 3);
  EXPECT_TRUE(said("no registration.json"));
  Registration failed;
  failed.verdict.reasons = {"x"};
  EXPECT_EQ(run({"evaluate", write("failed.json", registration_json(failed, "1", JsonStyle::compact)),
                 "--truth", truth}),
            1);
}

TEST_F(EvaluateCommand, ModelInfoRefusesWhatIsNoModel) {
  EXPECT_EQ(run({"model", "info", path("missing.vbm")}), 2);
  EXPECT_EQ(run({"model", "info", write("x.vbm", "not a model")}), 2);
  EXPECT_TRUE(said("x.vbm"));
}

TEST_F(EvaluateCommand, ModelInfoPrintsTheBundledBody) {
  const std::string body = std::string(VITRUVIAN_MODELS_DIR) + "/body.vbm";
  if (!std::filesystem::exists(body)) GTEST_SKIP() << "the models are not built";
  EXPECT_EQ(run({"model", "info", body}), 0) << error();
  EXPECT_NE(out().find("joints      24"), std::string::npos) << out();
  EXPECT_NE(out().find("right_hand_index"), std::string::npos);
}

TEST_F(EvaluateCommand, HelpAndVersionGoToStdout) {
  EXPECT_EQ(run({"--version"}), 0);
  EXPECT_EQ(out(), std::string("vitruvian ") + VITRUVIAN_VERSION + "\n");
  EXPECT_EQ(run({"help", "register"}), 0);
  EXPECT_NE(out().find("--out"), std::string::npos);
  EXPECT_EQ(error(), "");
}

}  // namespace
}  // namespace vitruvian
