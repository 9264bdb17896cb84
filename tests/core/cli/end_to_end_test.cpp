#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "cli/wiring.h"
#include "core/cli/cli_fixture.h"
#include "core/fit/fit_fixtures.h"
#include "io/mesh_writer.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using testing::default_body;

/// The whole program in-process: real models, real networks, scans of the default body.
class EndToEnd : public CliTest {
 protected:
  EndToEnd() {
    const char* data = std::getenv("VITRUVIAN_DATA");
    open_ = native_register({data ? data : VITRUVIAN_MODELS_DIR, VITRUVIAN_SOURCE_DIR "/models"});
  }

  /// Each triangle cut into three at a random place: another mesh of the same surface.
  static void remesh(const Points3d& vertices, Points3d& new_vertices, Faces& new_faces) {
    const Faces& faces = default_body().faces;
    Random random(77);
    new_vertices.resize(3, vertices.cols() + faces.cols());
    new_vertices.leftCols(vertices.cols()) = vertices;
    new_faces.resize(3, 3 * faces.cols());
    for (Index f = 0; f < faces.cols(); ++f) {
      Vec3d weights(random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1));
      weights /= weights.sum();
      const int middle = static_cast<int>(vertices.cols() + f);
      new_vertices.col(middle).setZero();
      for (int k = 0; k < 3; ++k) {
        new_vertices.col(middle) += weights[k] * vertices.col(faces(k, f));
        new_faces.col(3 * f + k) << faces(k, f), faces((k + 1) % 3, f), middle;
      }
    }
  }

  /// Writes the body as a scan; `scan_from_body` carries the unit.
  std::string write_body_scan(const std::string& name, const BodyState& state,
                              const Mat4d& scan_from_body) const {
    Points3d vertices;
    Faces faces;
    remesh(posed_vertices<double>(default_body(), state), vertices, faces);
    vertices =
        ((scan_from_body.topLeftCorner<3, 3>() * vertices).colwise() + scan_from_body.topRightCorner<3, 1>())
            .eval();
    return write(name, to_ply({.vertices = vertices, .faces = faces}));
  }

  int register_scan(const std::string& scan, const std::string& out) {
    return run({"register", scan, "--out", path(out), "--threads", "2", "--quiet"});
  }

  Registration registration(const std::string& folder) const {
    return parse_registration(read(folder + "/registration.json"), folder);
  }

  /// The registered mesh as it follows from the JSON and the model alone, scan frame.
  static Points3d rebuilt(const Registration& r) {
    const Points3d posed = posed_vertices<double>(
        default_body(),
        BodyState::from_axis_angle(r.parameters->pose, r.parameters->betas, r.parameters->translation_m));
    const Mat4d scan_from_body = r.alignment.body_from_scan.inverse();
    return (scan_from_body.topLeftCorner<3, 3>() * posed).colwise() + scan_from_body.topRightCorner<3, 1>();
  }
};

TEST_F(EndToEnd, TheSameBodyInTwoFramesAndUnitsGivesTheSameMesh) {
  BodyState state = testing::test_state(4, 42);
  state.translation.setZero();
  Mat4d metres = Mat4d::Identity();
  metres.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.7, Vec3d::UnitY()).toRotationMatrix();
  Mat4d millimetres = Mat4d::Identity();
  Mat3d z_up;
  z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  millimetres.topLeftCorner<3, 3>() =
      1000 * Eigen::AngleAxisd(-2.1, Vec3d::UnitZ()).toRotationMatrix() * z_up;
  millimetres.topRightCorner<3, 1>() = Vec3d(1500, -300, 900);

  ASSERT_EQ(register_scan(write_body_scan("y_up.ply", state, metres), "one"), 0) << error();
  ASSERT_EQ(register_scan(write_body_scan("z_up.ply", state, millimetres), "two"), 0) << error();
  const Registration one = registration("one/y_up"), two = registration("two/z_up");
  EXPECT_EQ(one.verdict.status, VerdictStatus::ok);
  EXPECT_EQ(two.verdict.status, VerdictStatus::ok);
  EXPECT_EQ(one.alignment.unit, Unit::metre);
  EXPECT_EQ(two.alignment.unit, Unit::millimetre);
  EXPECT_LT(one.surface_error->surface_all.mean_mm, 1);
  EXPECT_LT(two.surface_error->surface_all.mean_mm, 1);

  const auto to_body = [](const Mat4d& scan_from_body, const Points3d& points) {
    const Mat4d inverse = scan_from_body.inverse();
    return Points3d((inverse.topLeftCorner<3, 3>() * points).colwise() + inverse.topRightCorner<3, 1>());
  };
  const Points3d truth = posed_vertices<double>(default_body(), state);
  const Points3d from_one = to_body(metres, rebuilt(one)), from_two = to_body(millimetres, rebuilt(two));
  EXPECT_LT((from_one - from_two).colwise().norm().mean(), 0.003);
  EXPECT_LT((from_one - truth).colwise().norm().mean(), 0.005);
  const Skeleton skeleton = pose_skeleton(default_body(), state);
  for (int j = 0; j < 22; ++j) {
    const Vec3d joint = metres.topLeftCorner<3, 3>() * skeleton.joints.col(j);
    EXPECT_LT((one.joints[j].scan - joint).norm(), 0.015) << one.joints[j].name;
  }

  // The mesh that was written is the one that follows from the JSON.
  const Scan written = read_scan(std::as_bytes(std::span(std::string_view(read("two/z_up/registered.ply")))),
                                 "registered.ply", Execution(1));
  const Points3d mesh = written.vertices.cast<double>().colwise() + written.origin;
  ASSERT_EQ(mesh.cols(), truth.cols());
  EXPECT_LT((mesh - rebuilt(two)).colwise().norm().maxCoeff(), 0.01);
  EXPECT_EQ(written.faces, default_body().faces);
  EXPECT_TRUE(exists("two/z_up/errors.csv"));

  // A second run gives the same bytes but for the times.
  ASSERT_EQ(register_scan(path("z_up.ply"), "again"), 0) << error();
  const auto without_times = [&](const std::string& folder) {
    nlohmann::json json = nlohmann::json::parse(read(folder + "/registration.json"));
    json.erase("timing_ms");
    return json.dump();
  };
  EXPECT_EQ(without_times("again/z_up"), without_times("two/z_up"));
  EXPECT_EQ(read("again/z_up/registered.ply"), read("two/z_up/registered.ply"));
  EXPECT_EQ(read("again/z_up/errors.csv"), read("two/z_up/errors.csv"));
}

// Front and side view mirror a body easily; the raised arm must stay the left one, as published and as ours.
TEST_F(EndToEnd, ARaisedLeftArmStaysLeftWithTwoViewsAndWithEight) {
  BodyState state = BodyState::rest(default_body());
  const auto index = [](std::string_view name) {
    const auto& names = default_body().joint_names;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  // About +Z the left arm, along +X, goes up; the right one, along -X, goes down.
  for (const char* shoulder : {"left_shoulder", "right_shoulder"}) {
    state.rotation[index(shoulder)] = Eigen::AngleAxisd(1.2, Vec3d::UnitZ()).toRotationMatrix();
  }
  const std::string scan = write_body_scan("arm.ply", state, Mat4d::Identity());
  for (const char* views : {"2", "8"}) {
    const std::string out = std::string("views") + views;
    ASSERT_EQ(run({"register", scan, "--out", path(out), "--views", views, "--quiet"}), 0) << error();
    const Registration result = registration(out + "/arm");
    const Keypoint &left = result.keypoints[index("left_wrist")],
                   &right = result.keypoints[index("right_wrist")];
    ASSERT_TRUE(left.position_m && right.position_m);
    EXPECT_GT(left.position_m->y(), right.position_m->y() + 0.5) << views << " views";
    EXPECT_GT(left.position_m->x(), right.position_m->x()) << views << " views";
    EXPECT_GT(result.joints[index("left_wrist")].body_m.y(),
              result.joints[index("right_wrist")].body_m.y() + 0.5);
    EXPECT_EQ(result.verdict.status, VerdictStatus::ok);
  }
}

// Something that is no body must not be called one.
TEST_F(EndToEnd, ABallIsNotOk) {
  constexpr int kRings = 40, kSectors = 80;
  Points3d vertices(3, kRings * kSectors);
  for (int r = 0; r < kRings; ++r) {
    for (int s = 0; s < kSectors; ++s) {
      const double polar = std::numbers::pi * (r + 0.5) / kRings,
                   azimuth = 2 * std::numbers::pi * s / kSectors;
      vertices.col(r * kSectors + s) = 0.85 * Vec3d(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                                    std::sin(polar) * std::sin(azimuth));
    }
  }
  Faces faces(3, 2 * (kRings - 1) * kSectors);
  Index face = 0;
  for (int r = 0; r + 1 < kRings; ++r) {
    for (int s = 0; s < kSectors; ++s) {
      const int a = r * kSectors + s, b = r * kSectors + (s + 1) % kSectors;
      faces.col(face++) << a, b, b + kSectors;
      faces.col(face++) << a, b + kSectors, a + kSectors;
    }
  }
  const std::string scan = write("ball.ply", to_ply({.vertices = vertices, .faces = faces}));
  EXPECT_EQ(register_scan(scan, "out"), 1) << error();
  EXPECT_NE(registration("out/ball").verdict.status, VerdictStatus::ok);
}

}  // namespace
}  // namespace vitruvian
