#include "pipeline/pipeline.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <string>

#include "core/pipeline/all_knowing_network.h"
#include "pipeline/check_settings.h"
#include "pipeline/outcome.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using namespace testing;

Registration registered(const BodyState& truth, const Settings& settings, const Execution& execution) {
  const AllKnowingNetwork network(truth);
  RegistrationPipeline pipeline(models(), settings, execution);
  pipeline.set_scan(scan_of(truth));
  int requests = 0;
  while (const auto request = pipeline.next_request()) {
    ++requests;
    pipeline.accept(network.run(pipeline, *request));
  }
  EXPECT_EQ(requests, 1);
  return pipeline.finish();
}

TEST(RegistrationPipeline, RegistersWhatAnAllKnowingNetworkSees) {
  const BodyState truth = standing();
  const Registration r = registered(truth, pca_settings(), Execution(2));
  EXPECT_EQ(r.verdict.status, VerdictStatus::ok);
  ASSERT_TRUE(r.surface_error && r.parameters);
  EXPECT_LT(r.surface_error->surface_all.mean_mm, 0.5);
  EXPECT_LT(r.surface_error->scan_to_model.mean_mm, 0.5);
  EXPECT_EQ(r.alignment.unit, Unit::millimetre);
  const Points3d joints = to_scan(pose_skeleton(default_body(), truth).joints);
  ASSERT_EQ(r.joints.size(), 24u);
  for (int j = 0; j < 22; ++j) {
    EXPECT_LT((r.joints[j].scan - joints.col(j)).norm(), 10) << r.joints[j].name;
    const Vec3d in_body = r.alignment.body_from_scan.topLeftCorner<3, 3>() * r.joints[j].scan +
                          r.alignment.body_from_scan.topRightCorner<3, 1>();
    EXPECT_LT((in_body - r.joints[j].body_m).norm(), 1e-8);
  }
  // The mesh is in the scan's frame and units, vertex by vertex the scanned body's own.
  const Points3d vertices = to_scan(posed_vertices<double>(default_body(), truth));
  ASSERT_EQ(r.registered_vertices.cols(), vertices.cols());
  EXPECT_LT((r.registered_vertices - vertices).colwise().norm().mean(), 4);
  EXPECT_EQ(r.vertex_error_mm.size(), static_cast<std::size_t>(vertices.cols()));
  ASSERT_EQ(r.keypoints.size(), 22u);
  EXPECT_EQ(r.keypoints[4].joint, "left_knee");
  ASSERT_TRUE(r.keypoints[4].position_m);
  EXPECT_LT((*r.keypoints[4].position_m - r.joints[4].body_m).norm(), 0.05);
}

TEST(RegistrationPipeline, DetailAddsOffsetsAndJudgesTheBodyWithoutThem) {
  BodyState truth = standing();
  Settings settings = pca_settings();
  // Too few shape components for this body: something is left for the offsets.
  truth.betas.setConstant(0.6);
  settings.betas = 2;
  const Registration without = registered(truth, settings, Execution(2));
  settings.detail = DetailMode::vertex;
  const Registration with = registered(truth, settings, Execution(2));
  EXPECT_EQ(without.offsets.cols(), 0);
  EXPECT_FALSE(without.parametric_error);
  EXPECT_EQ(without.timing_ms.detail, 0);
  ASSERT_EQ(with.offsets.cols(), default_body().vertex_count());
  EXPECT_EQ(with.parameters->offsets_file, "offsets.npz");
  EXPECT_GT(with.timing_ms.detail, 0);
  ASSERT_TRUE(with.parametric_error);
  EXPECT_EQ(with.parametric_error->surface_all.mean_mm, without.surface_error->surface_all.mean_mm);
  EXPECT_GT(without.surface_error->surface_all.mean_mm, 1.5);
  EXPECT_LT(with.surface_error->surface_all.mean_mm, 1);
  EXPECT_EQ(with.verdict.confidence, without.verdict.confidence);
  EXPECT_EQ(with.parameters->pose, without.parameters->pose);
  const Points3d body =
      posed_vertices<double>(default_body(),
                             BodyState::from_axis_angle(with.parameters->pose, with.parameters->betas,
                                                        with.parameters->translation_m),
                             with.offsets);
  const Mat4d inverse = with.alignment.body_from_scan.inverse();
  const Points3d rebuilt = (inverse.topLeftCorner<3, 3>() * body).colwise() + inverse.topRightCorner<3, 1>();
  EXPECT_LT((rebuilt - with.registered_vertices).colwise().norm().maxCoeff(), 0.01);
}

TEST(RegistrationPipeline, GivesTheSameBytesAgainButForTimes) {
  const auto json = [] {
    Registration r = registered(standing(), pca_settings(), Execution(2));
    r.timing_ms = Timing();
    return registration_json(r, "1", JsonStyle::pretty);
  };
  EXPECT_EQ(json(), json());
}

TEST(RegistrationPipeline, StopsWhenCancelledAtAnyStage) {
  for (const std::string stage : {"align", "project", "detect", "fit", "refine"}) {
    SCOPED_TRACE(stage);
    Execution execution(2);
    bool reached = false;
    execution.on_progress([&](std::string_view now, double) {
      if (now != stage) return;
      reached = true;
      execution.cancel();
    });
    try {
      registered(standing(), pca_settings(), execution);
      ADD_FAILURE() << "was not cancelled";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_TRUE(reached);
  }
}

TEST(RegistrationPipeline, RefusesToFinishBeforeItsAnswers) {
  const Execution execution(2);
  RegistrationPipeline pipeline(models(), pca_settings(), execution);
  pipeline.set_scan(scan_of(standing()));
  const auto request = pipeline.next_request();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->network, Network::landmarks);
  EXPECT_EQ(request->inputs.size(), 8u);
  EXPECT_THROW(pipeline.finish(), Error);
  NetworkReply wrong;
  wrong.outputs.resize(7);
  EXPECT_THROW(pipeline.accept(wrong), Error);
}

TEST(RegistrationPipeline, RefusesViewsOtherThanTwoOrEight) {
  const Execution execution(1);
  Settings settings;
  settings.views = 5;
  try {
    RegistrationPipeline pipeline(models(), settings, execution);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
  }
}

Settings millimetres() {
  Settings settings;
  settings.unit = Unit::millimetre;
  settings.threads = 2;
  return settings;
}

/// Registers without networks: fails the test when one is asked for.
Registration registered_blind(const Scan& scan, const Settings& settings) {
  const Execution execution(2);
  RegistrationPipeline pipeline(models(), settings, execution);
  pipeline.set_scan(scan);
  EXPECT_FALSE(pipeline.next_request());
  return pipeline.finish();
}

void expect_registered(const Registration& r, const BodyState& truth) {
  EXPECT_EQ(r.verdict.status, VerdictStatus::ok);
  ASSERT_TRUE(r.surface_error);
  EXPECT_LT(r.surface_error->surface_all.mean_mm, 0.5);
  const Points3d joints = to_scan(pose_skeleton(default_body(), truth).joints);
  for (int j = 0; j < 22; ++j) EXPECT_LT((r.joints[j].scan - joints.col(j)).norm(), 10) << r.joints[j].name;
}

KeypointSet true_keypoints(const BodyState& state, KeypointFrame frame, const Mat4d& body_from_scan) {
  const Points3d joints = to_scan(pose_skeleton(default_body(), state).joints);
  KeypointSet set{frame, {}};
  for (int j = 0; j < 22; ++j) {
    Vec3d p = joints.col(j);
    if (frame != KeypointFrame::scan) p = (body_from_scan * p.homogeneous()).head<3>();
    if (frame == KeypointFrame::canonical) p = Vec3d(-p.x(), p.z(), p.y());
    set.joints[std::string(kSmplJointNames[j])] = {p, 1};
  }
  return set;
}

TEST(RegistrationPipeline, TakesKeypointsOfTheScanFrameInsteadOfLooking) {
  const BodyState truth = standing();
  Settings settings = millimetres();
  settings.keypoints = true_keypoints(truth, KeypointFrame::scan, {});
  const Registration r = registered_blind(scan_of(truth), settings);
  expect_registered(r, truth);
  EXPECT_EQ(r.alignment.method, "keypoints");
  EXPECT_EQ(r.alignment.up, "z");
  for (const Keypoint& k : r.keypoints) EXPECT_EQ(k.source, KeypointSource::user);
}

TEST(RegistrationPipeline, TakesAnAlignmentAndKeypointsOfTheBodyOrCanonicalFrame) {
  const BodyState truth = standing();
  const Mat4d body_from_scan = scan_from_body().inverse();
  for (const KeypointFrame frame : {KeypointFrame::body, KeypointFrame::canonical}) {
    Settings settings;
    settings.body_from_scan = body_from_scan;
    settings.keypoints = true_keypoints(truth, frame, body_from_scan);
    const Registration r = registered_blind(scan_of(truth), settings);
    expect_registered(r, truth);
    EXPECT_EQ(r.alignment.method, "given");
    EXPECT_EQ(r.alignment.body_from_scan, body_from_scan);
    EXPECT_EQ(r.alignment.unit, Unit::millimetre);
    EXPECT_LT((r.parameters->translation_m - truth.translation).norm(), 0.01);
  }
}

TEST(RegistrationPipeline, StartsFromAnEarlierRegistration) {
  const BodyState truth = standing();
  Settings settings;
  settings.body_from_scan = scan_from_body().inverse();
  settings.init = InitMode::file;
  const BodyState earlier = testing::perturbed(truth, 0.2, 0.5, 5);
  settings.start =
      StartBody{{earlier.betas, earlier.axis_angle(), earlier.translation}, default_body().sha256};
  const Registration r = registered_blind(scan_of(truth), settings);
  expect_registered(r, truth);
  EXPECT_EQ(r.settings.init, InitMode::file);
  for (const Keypoint& k : r.keypoints) EXPECT_EQ(k.source, KeypointSource::none);
}

TEST(RegistrationPipeline, StartsFromTheRestPose) {
  // Near enough to the rest pose for any solver.
  BodyState truth = BodyState::rest(default_body());
  for (const int joint : {16, 17}) {
    truth.rotation[joint] = Eigen::AngleAxisd(joint == 16 ? -0.3 : 0.3, Vec3d::UnitZ()).toRotationMatrix();
  }
  Settings settings;
  settings.body_from_scan = scan_from_body().inverse();
  settings.init = InitMode::tpose;
  expect_registered(registered_blind(scan_of(truth), settings), truth);
}

TEST(CheckSettings, RefusesWhatContradictsItself) {
  const KeypointSet keypoints = true_keypoints(standing(), KeypointFrame::scan, {});
  const BodyParameters body{Eigen::VectorXd::Zero(32), Points3d::Zero(3, 24), Vec3d::Zero()};
  const std::vector<std::pair<const char*, std::function<void(Settings&)>>> cases = {
      {"--align pca", [](Settings& s) { s.body_from_scan = Mat4d::Identity(), s.align = AlignMode::pca; }},
      {"--up", [](Settings& s) { s.body_from_scan = Mat4d::Identity(), s.up = Axis::z; }},
      {"--units", [](Settings& s) { s.body_from_scan = Mat4d::Identity(), s.unit = Unit::metre; }},
      {"--init tpose", [&](Settings& s) { s.keypoints = keypoints, s.init = InitMode::tpose; }},
      {"at least 3",
       [&](Settings& s) {
         s.keypoints = KeypointSet{{}, {{"head", {}}, {"neck", {}}}};
       }},
      {"another model",
       [&](Settings& s) {
         s.init = InitMode::file, s.start = StartBody{body, "other"};
       }},
      {"2 joints",
       [&](Settings& s) {
         s.init = InitMode::file;
         s.start = StartBody{{body.betas, Points3d::Zero(3, 2), {}}, default_body().sha256};
       }},
  };
  for (const auto& [said, change] : cases) {
    SCOPED_TRACE(said);
    Settings settings;
    change(settings);
    try {
      check_settings(settings, models());
      ADD_FAILURE() << "was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }
  EXPECT_NO_THROW(check_settings(Settings(), models()));
}

TEST(PreparedScan, TurnsInsideOutScansAndFindsTheirSize) {
  Scan scan = scan_of(standing());
  const Execution execution(1);
  const PreparedScan right(scan, execution);
  scan.faces = scan.faces.colwise().reverse().eval();
  const PreparedScan inside_out(scan, execution);
  EXPECT_LT((right.normals - inside_out.normals).cwiseAbs().maxCoeff(), 1e-4f);
  EXPECT_NEAR(right.extent, 1000 * standing_stature(default_body(), standing().betas), 60);
  const Vec3d middle = to_scan(posed_vertices<double>(default_body(), standing())).rowwise().mean();
  EXPECT_LT((right.centroid - middle).norm(), 300);
}

TEST(PreparedScan, LeavesAFloorOutOfThePictures) {
  Scan scan = scan_of(standing());
  const PreparedScan alone(scan, Execution(1));
  constexpr int kSide = 60;
  const Index body_vertices = scan.vertices.cols(), body_faces = scan.faces.cols();
  const float height = scan.vertices.row(2).minCoeff() - 15;
  const Vec3f centre = scan.vertices.rowwise().mean();
  scan.vertices.conservativeResize(3, body_vertices + kSide * kSide);
  scan.faces.conservativeResize(3, body_faces + 2 * (kSide - 1) * (kSide - 1));
  Index face = body_faces;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int row = i / kSide, column = i % kSide;
    scan.vertices.col(body_vertices + i) =
        Vec3f(centre[0] + 40.0f * static_cast<float>(row - kSide / 2),
              centre[1] + 40.0f * static_cast<float>(column - kSide / 2), height);
    if (row + 1 == kSide || column + 1 == kSide) continue;
    const int at = static_cast<int>(body_vertices) + i;
    scan.faces.col(face++) << at, at + kSide, at + kSide + 1;
    scan.faces.col(face++) << at, at + kSide + 1, at + 1;
  }
  const PreparedScan standing_on_it(scan, Execution(1));
  EXPECT_NEAR(standing_on_it.extent, alone.extent, 100);
  EXPECT_LT((standing_on_it.centroid - alone.centroid).norm(), 100);
}

TEST(PlacedScan, LiesInTheBodyFrameWithUnitNormals) {
  const BodyState truth = standing();
  const Execution execution(2);
  const PreparedScan prepared(scan_of(truth), execution);
  const PlacedScan placed(prepared, scan_from_body().inverse(), execution);
  const Points3f expected = posed_vertices<float>(default_body(), truth);
  EXPECT_LT((placed.points() - expected).cwiseAbs().maxCoeff(), 1e-5f);
  EXPECT_LT((placed.normals() - vertex_normals(expected, default_body().faces)).cwiseAbs().maxCoeff(), 2e-3f);
  const ScanSurface surface = placed.surface();
  ASSERT_NE(surface.mesh, nullptr);
  EXPECT_LT(surface.mesh->query(expected.col(100)).distance, 1e-5f);
  EXPECT_LT(surface.tree.nearest(expected.col(100)).squared_distance, 1e-9f);

  Scan cloud = scan_of(truth);
  cloud.faces.resize(3, 0);
  const PreparedScan prepared_cloud(cloud, execution);
  EXPECT_EQ(PlacedScan(prepared_cloud, scan_from_body().inverse(), execution).surface().mesh, nullptr);
  // Normals of the bare cloud point outward too, but for folds between touching skin.
  EXPECT_GT(
      ((prepared_cloud.normals.array() * prepared.normals.array()).colwise().sum() > 0).cast<double>().mean(),
      0.93);
}

std::vector<Landmark3d> some_landmarks() {
  std::vector<Landmark3d> landmarks(kLandmarkCount);
  for (int l = 0; l < kLandmarkCount; ++l) {
    landmarks[l] = {Vec3f(static_cast<float>(l), 1, 2), 0.9f, 0.005f};
  }
  return landmarks;
}

TEST(LandmarkTargets, TrustLandmarksOnWhichTheViewsAgree) {
  std::vector<Landmark3d> landmarks = some_landmarks();
  landmarks[15].residual = 0.06f;
  landmarks[16].residual = 5;
  landmarks[25].confidence = 0;
  const std::vector<LandmarkTarget> targets = landmark_targets(models().landmarks, landmarks);
  ASSERT_EQ(targets.size(), models().landmarks.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const LandmarkOffset& offset = models().landmarks[i];
    EXPECT_EQ(targets[i].landmark, offset.landmark);
    EXPECT_EQ(targets[i].target, landmarks[offset.landmark].position.cast<double>());
    const double share = offset.landmark == 15   ? 0.5
                         : offset.landmark == 16 ? 0.15
                         : offset.landmark == 25 ? 0
                                                 : 1;
    EXPECT_NEAR(targets[i].weight, share * offset.weight, 1e-6) << offset.landmark;
  }
}

TEST(SmplKeypoints, NameTheirSourceAndHideWhatIsUnknown) {
  std::vector<Landmark3d> landmarks = some_landmarks();
  landmarks[13].confidence = 0;  // left elbow
  const std::vector<Keypoint> keypoints = smpl_keypoints(landmarks);
  ASSERT_EQ(keypoints.size(), 22u);
  for (std::size_t j = 0; j < 22; ++j) EXPECT_EQ(keypoints[j].joint, kSmplJointNames[j]);
  EXPECT_EQ(keypoints[18].source, KeypointSource::none);
  EXPECT_FALSE(keypoints[18].position_m);
  EXPECT_EQ(keypoints[18].confidence, 0);
  EXPECT_EQ(keypoints[19].source, KeypointSource::detected);
  EXPECT_EQ(keypoints[0].source, KeypointSource::derived);
}

TEST(Outcome, StatureAndUnits) {
  const Eigen::VectorXd mean = Eigen::VectorXd::Zero(default_body().beta_count());
  const Points3f& rest = default_body().v_template;
  EXPECT_NEAR(standing_stature(default_body(), mean), rest.row(1).maxCoeff() - rest.row(1).minCoeff(), 1e-5);
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch}) {
    EXPECT_EQ(unit_named(to_string(unit)), unit);
  }
  EXPECT_EQ(unit_named("furlong"), Unit::automatic);
}

}  // namespace
}  // namespace vitruvian
