#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/wiring.h"
#include "core/cli/cli_fixture.h"
#include "core/fit/fit_fixtures.h"
#include "io/mesh_writer.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using testing::default_body;

/// Stages of the published method through the command line, with real models and networks, on the default
/// body itself.
class PublishedStages : public CliTest {
 protected:
  PublishedStages() {
    const char* data = std::getenv("VITRUVIAN_DATA");
    open_ = native_register({data ? data : VITRUVIAN_MODELS_DIR, VITRUVIAN_SOURCE_DIR "/models"});
  }

  std::string write_body(const BodyState& state) const {
    return write("body.ply", to_ply({.vertices = posed_vertices<double>(default_body(), state),
                                     .faces = default_body().faces}));
  }

  Registration registered(const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"register", path("body.ply"), "--out", path("out"), "--threads",
                                          "2",        "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_LE(run(arguments), 1) << error();
    return parse_registration(read("out/body/registration.json"), "out");
  }

  /// Arms 20 degrees from hanging.
  static BodyState arms_down() {
    BodyState state = BodyState::rest(default_body());
    state.rotation[16] = Eigen::AngleAxisd(-1.2, Vec3d::UnitZ()).toRotationMatrix();
    state.rotation[17] = Eigen::AngleAxisd(1.2, Vec3d::UnitZ()).toRotationMatrix();
    return state;
  }

  /// Largest error of a joint, m.
  static double worst_joint(const Registration& r, const BodyState& truth) {
    const Points3d joints = pose_skeleton(default_body(), truth).joints;
    double worst = 0;
    for (int j = 0; j < 22; ++j) worst = std::max(worst, (r.joints.at(j).scan - joints.col(j)).norm());
    return worst;
  }
};

TEST_F(PublishedStages, EachWorksByItselfInOurPipeline) {
  const BodyState truth = arms_down();
  write_body(truth);
  const std::vector<std::pair<std::vector<std::string>, double>> stages = {
      {{"--align", "pca", "--units", "m"}, 0.005},
      {{"--views", "2", "--min-visibility", "0.25"}, 0.005},
      {{"--init", "keypoints"}, 0.005},
      {{"--solver", "paper", "--iterations", "60", "--adam-iterations", "30"}, 0.04}};
  for (const auto& [options, most] : stages) {
    SCOPED_TRACE(options[0]);
    EXPECT_LT(worst_joint(registered(options), truth), most);
  }
}

TEST_F(PublishedStages, TheVisibilityThresholdIsHalfOfWhatTheRestPoseReads) {
  write_body(BodyState::rest(default_body()));
  const Registration r = registered({"--method", "paper", "--iterations", "1"});
  double least = 1;
  for (const Keypoint& keypoint : r.keypoints) {
    EXPECT_NE(keypoint.source, KeypointSource::none) << keypoint.joint;
    if (keypoint.source == KeypointSource::detected) least = std::min(least, keypoint.confidence);
  }
  EXPECT_NEAR(0.5 * least, kPaperMinVisibility, 0.02);
}

/// Hands side by side in front of the body, each painted as the other's: no pair is crossed, so from the
/// right body both solvers must bring each hand to where the other one is.
TEST_F(PublishedStages, RegionsRestrictBothSolvers) {
  BodyState truth = BodyState::rest(default_body());
  truth.rotation[16] = Eigen::AngleAxisd(-1.75, Vec3d::UnitY()).toRotationMatrix();
  truth.rotation[17] = Eigen::AngleAxisd(1.75, Vec3d::UnitY()).toRotationMatrix();
  write_body(truth);
  const auto forearm = [&](int wrist) {
    std::vector<int> vertices;
    for (int v = 0; v < default_body().vertex_count(); ++v) {
      const int segment = default_body().segment[static_cast<std::size_t>(v)];
      if (segment == wrist - 2 || segment == wrist || segment == wrist + 2) vertices.push_back(v);
    }
    return vertices;
  };
  const std::vector<int> left = forearm(20), right = forearm(21);
  const auto pair = [](const char* name, const std::vector<int>& scan, const std::vector<int>& body) {
    return nlohmann::json{{"name", name}, {"scan_vertices", scan}, {"template_vertices", body}};
  };
  const std::string identity = write("align.json", "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]");
  const Registration first = registered({"--init", "tpose", "--align-file", identity});
  ASSERT_LT(worst_joint(first, truth), 1e-3);
  write("first.json", read("out/body/registration.json"));
  const nlohmann::json regions = {{"scan_sha256", first.scan.sha256},
                                  {"model_sha256", first.model.sha256},
                                  {"pairs", {pair("left", right, left), pair("right", left, right)}}};
  write("regions.json", regions.dump());
  const Points3d joints = pose_skeleton(default_body(), truth).joints;
  const double apart = (joints.col(20) - joints.col(21)).norm();
  ASSERT_GT(apart, 0.05);
  for (const std::vector<std::string>& solver : std::vector<std::vector<std::string>>{
           {"--solver", "fast"}, {"--solver", "paper", "--iterations", "150", "--adam-iterations", "150"}}) {
    SCOPED_TRACE(solver[1]);
    std::vector<std::string> options = {"--init", path("first.json"), "--align-file", identity};
    options.insert(options.end(), solver.begin(), solver.end());
    EXPECT_LT(worst_joint(registered(options), truth), 0.2 * apart) << "without regions";
    options.insert(options.end(), {"--regions", path("regions.json")});
    const Registration r = registered(options);
    ASSERT_TRUE(r.settings.regions);
    for (const auto& [mine, other] : {std::pair{20, 21}, std::pair{21, 20}}) {
      EXPECT_LT((r.joints.at(mine).scan - joints.col(other)).norm(), 0.5 * apart) << apart;
    }
  }
}

}  // namespace
}  // namespace vitruvian
