#include "cli/model_loading.h"

#include <Eigen/Geometry>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/wiring.h"
#include "core/cli/cli_fixture.h"
#include "core/fit/fit_fixtures.h"
#include "io/mesh_writer.h"
#include "pipeline/body_parameters.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using testing::default_body;

std::string smpl_file(const std::string& name) { return VITRUVIAN_SMPL_FILES "/" + name; }

class ModelLoading : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    const char* data = std::getenv("VITRUVIAN_DATA");
    folders_ = {data ? data : VITRUVIAN_MODELS_DIR, VITRUVIAN_SOURCE_DIR "/models"};
    cache_ = path("cache");
    open_ = native_register(folders_, cache_);
  }
  std::vector<std::string> folders_;
  std::string cache_;
};

TEST(CacheFolder, FollowsTheEnvironment) {
  EXPECT_EQ(cache_folder("/x/cache", "/home/a"), "/x/cache/vitruvian");
  EXPECT_EQ(cache_folder("relative", "/home/a"), "/home/a/.cache/vitruvian");
  EXPECT_EQ(cache_folder(nullptr, "/home/a"), "/home/a/.cache/vitruvian");
  EXPECT_EQ(cache_folder(nullptr, nullptr), "");
}

TEST_F(ModelLoading, CalibrationsAreKeptAndDamagedOnesIgnored) {
  const CalibrationCache cache(cache_);
  const std::string key(64, 'a');
  EXPECT_FALSE(cache.find(key));
  const std::vector<LandmarkOffset> landmarks = {{11, 16, 13, Vec3d(0.1, -0.2, 0.03), 0.7}};
  cache.keep(key, landmarks);
  const auto found = cache.find(key);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ((*found)[0].frame_joint, 13);
  EXPECT_EQ((*found)[0].offset, landmarks[0].offset);
  const std::string name = "cache/" + key + ".landmarks", good = read(name);
  for (std::size_t at = 0; at < good.size(); at += 3) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    write(name, bad);
    EXPECT_FALSE(cache.find(key)) << "byte " << at;
    write(name, good.substr(0, at));
    EXPECT_FALSE(cache.find(key)) << "cut to " << at;
  }
  CalibrationCache("").keep(key, landmarks);
  CalibrationCache("/proc/nowhere").keep(key, landmarks);
}

TEST_F(ModelLoading, FilesThatAreNoModelsAreWrongUsage) {
  const std::string scan = write_scan("a.ply");
  const auto refuses = [&](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> arguments = {"register", scan, "--out", path("out")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments), 2) << words;
    EXPECT_TRUE(said(words)) << error();
    EXPECT_FALSE(exists("out"));
  };
  refuses({"--model", path("missing.pkl")}, "missing.pkl");
  refuses({"--model", scan}, "neither a NumPy archive (.npz) nor a pickle (.pkl)");
  refuses({"--model", smpl_file("dmpl.npz")}, "has no array 'v_template', only: eigvec");
  refuses({"--model", smpl_file("tiny_smpl.npz"), "--betas", "99"}, "--betas 99");
  refuses({"--model", smpl_file("tiny_smpl.npz"), "--dmpl", smpl_file("dmpl.npz")}, "eigvec: has the shape");
  refuses({"--prior", smpl_file("dmpl.npz")}, "no PyTorch archive");
}

/// A scan of the default body, registered with the bundled model and with the same model in an SMPL file: the
/// landmarks are learnt from one and shipped with the other, so the fits start apart and must end together.
TEST_F(ModelLoading, TheSameBodyFromAnSmplFileRegistersTheSame) {
  BodyState state = BodyState::rest(default_body());
  state.rotation[16] = Eigen::AngleAxisd(-1.0, Vec3d::UnitZ()).toRotationMatrix();
  state.rotation[17] = Eigen::AngleAxisd(1.1, Vec3d::UnitZ()).toRotationMatrix();
  state.betas[0] = 0.8;
  state.betas[2] = -0.6;
  const std::string scan = write(
      "body.ply",
      to_ply({.vertices = posed_vertices<double>(default_body(), state), .faces = default_body().faces}));
  const std::vector<std::string> common = {scan, "--threads", "2", "--quiet", "--units", "m", "--up", "y"};
  const auto registered = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"register", "--out", path(out)};
    arguments.insert(arguments.end(), common.begin(), common.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_LE(run(arguments), 1) << error();
    return parse_registration(read(out + "/body/registration.json"), out);
  };
  const Registration bundled = registered("bundled", {});
  // What a calibration of this body would find is known: no need to look at it here.
  const BodyModel same = load_body_model({smpl_file("own_smpl.npz"), "", "", 32}, folders_);
  const std::vector<std::byte> landmarks = testing::file_bytes(VITRUVIAN_SOURCE_DIR "/models/landmarks.json");
  CalibrationCache(cache_).keep(
      same.sha256, landmarks_from_json(
                       std::string(reinterpret_cast<const char*>(landmarks.data()), landmarks.size()), "l"));
  const Registration file = registered("file", {"--model", smpl_file("own_smpl.npz"), "--betas", "32"});
  EXPECT_EQ(file.model.family, "smpl");
  EXPECT_EQ(file.model.vertices, default_body().vertex_count());
  ASSERT_EQ(file.joints.size(), bundled.joints.size());
  double worst = 0;
  for (std::size_t j = 0; j < file.joints.size(); ++j)
    worst = std::max(worst, (file.joints[j].scan - bundled.joints[j].scan).norm());
  EXPECT_LT(worst, 1e-4);
}

/// The default body as SMPL .pkl, .npz and SMPL+H .pkl: the same vertices, and a scan registered from the
/// same keypoints ends at the same body.
TEST_F(ModelLoading, EveryFileOfTheSameBodyRegistersTheSameFromGivenKeypoints) {
  const BodyState truth = testing::test_state(2, 5);
  const Points3d vertices = posed_vertices<double>(default_body(), truth);
  const std::string scan = write("body.ply", to_ply({.vertices = vertices, .faces = default_body().faces}));
  nlohmann::json keypoints = {{"frame", "body"}, {"joints", nlohmann::json::object()}};
  const Points3d joints = pose_skeleton(default_body(), truth).joints;
  for (int j = 0; j < 22; ++j) {
    // A hand places them a centimetre off.
    const Vec3d p = joints.col(j) + 0.01 * Vec3d(j % 3 - 1, j % 2, (j + 1) % 3 - 1);
    keypoints["joints"][std::string(kSmplJointNames[static_cast<std::size_t>(j)])]["position"] = {
        p.x(), p.y(), p.z()};
  }
  const std::vector<std::string> common = {"register",
                                           scan,
                                           "--threads",
                                           "2",
                                           "--quiet",
                                           "--keypoints",
                                           write("keypoints.json", keypoints.dump()),
                                           "--align-file",
                                           write("align.json", "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")};
  const auto registered = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = common;
    arguments.insert(arguments.end(), {"--out", path(out)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_LE(run(arguments), 1) << error();
    const std::string mesh = read(out + "/body/registered.ply");
    return read_scan(std::as_bytes(std::span(std::string_view(mesh))), "registered.ply", Execution(1));
  };
  const Scan own = registered("own", {});
  // No landmark is looked for: any calibration will do.
  const std::vector<std::byte> text = testing::file_bytes(VITRUVIAN_SOURCE_DIR "/models/landmarks.json");
  const auto landmarks =
      landmarks_from_json(std::string(reinterpret_cast<const char*>(text.data()), text.size()), "l");
  for (const std::string name : {"own_smpl.pkl", "own_smpl.npz", "own_smplh.pkl"}) {
    SCOPED_TRACE(name);
    const BodyModel body = load_body_model({smpl_file(name), "", "", 32}, folders_);
    ASSERT_EQ(body.vertex_count(), default_body().vertex_count());
    EXPECT_LT((body.v_template - default_body().v_template).cwiseAbs().maxCoeff(), 1e-5);
    CalibrationCache(cache_).keep(body.sha256, landmarks);
    const Scan same = registered("file", {"--model", smpl_file(name), "--betas", "32"});
    ASSERT_EQ(same.vertices.cols(), own.vertices.cols());
    const Points3d difference = (same.vertices.cast<double>().colwise() + same.origin) -
                                (own.vertices.cast<double>().colwise() + own.origin);
    EXPECT_LT(difference.colwise().norm().maxCoeff(), 1e-4);
    EXPECT_LT((own.vertices.cast<double>().colwise() + own.origin - vertices).colwise().norm().mean(), 2e-3);
  }
}

/// Measures need the soft tissue that the registration was made with; it changes them.
TEST_F(ModelLoading, SoftTissueIsRecordedAndMeasured) {
  open_body_ = native_body(folders_);
  const BodyModel body = open_body_(smpl_file("SMPLH_NEUTRAL.npz"), smpl_file("dmpl.npz"));
  ASSERT_EQ(body.dmpl_count, 8);
  Registration r = sample_registration();
  r.model.sha256 = body.sha256;
  r.model.dmpl = file_info(smpl_file("dmpl.npz"));
  r.model.prior = FileInfo{"V02_05.ckpt", std::string(64, '0')};
  const BodyState rest = BodyState::rest(body);
  r.parameters = BodyParameters{
      .betas = Eigen::VectorXd::Zero(10), .pose = rest.axis_angle(), .translation_m = Vec3d::Zero()};
  r.parameters->dmpl = Eigen::VectorXd::Zero(8);
  const auto volume = [&](const std::vector<std::string>& more) {
    const std::string file = write("r.json", registration_json(r, "1", JsonStyle::pretty));
    std::vector<std::string> arguments = {"measure", file, "--model", smpl_file("SMPLH_NEUTRAL.npz")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments), 0) << error();
    return nlohmann::json::parse(out())["body"]["volume_cm3"].get<double>();
  };
  const std::vector<std::string> tissue = {"--dmpl", smpl_file("dmpl.npz")};
  const double without = volume(tissue);
  r.parameters->dmpl[3] = 1;
  EXPECT_GT(std::abs(volume(tissue) - without), 1);
  EXPECT_EQ(run({"measure", path("r.json"), "--model", smpl_file("SMPLH_NEUTRAL.npz")}), 2);
  EXPECT_TRUE(said("--dmpl")) << error();
  EXPECT_EQ(run({"measure", path("r.json"), "--model", smpl_file("SMPLH_NEUTRAL.npz"), "--dmpl",
                 smpl_file("SMPLH_NEUTRAL.npz")}),
            2);
  const Registration back = parse_registration(read("r.json"), "r");
  EXPECT_EQ(back.model.dmpl->sha256, r.model.dmpl->sha256);
  EXPECT_EQ(back.model.dmpl->file, "dmpl.npz");
  EXPECT_EQ(back.model.prior->file, "V02_05.ckpt");
}

}  // namespace
}  // namespace vitruvian
