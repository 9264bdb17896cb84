#include "smpl/smpl_model.h"

#include "core/fit/fit_fixtures.h"
#include "core/smpl/smpl_fixtures.h"
#include "smpl/families.h"

namespace vitruvian {
namespace {

using testing::default_body;
using testing::Expected;
using testing::read_smpl_file;
using testing::smpl_file;

double farthest(const Points3d& a, const Points3d& b) {
  EXPECT_EQ(a.cols(), b.cols());
  return a.cols() == b.cols() ? (a - b).colwise().norm().maxCoeff() : 1e9;
}

struct FileCase {
  const char* file;
  const char* expected;
  const char* family;
  int vertices, faces, joints, betas, shape, expression;
  std::optional<Gender> gender;
};

class SmplFiles : public ::testing::TestWithParam<FileCase> {};

TEST_P(SmplFiles, AreReadAndPosedAsPublished) {
  const FileCase& c = GetParam();
  SmplOptions options;
  options.betas = c.betas;
  BodyModel model = read_smpl_file(c.file, options);
  EXPECT_EQ(model.family, c.family);
  EXPECT_EQ(model.vertex_count(), c.vertices);
  EXPECT_EQ(model.face_count(), c.faces);
  EXPECT_EQ(model.joint_count(), c.joints);
  EXPECT_EQ(model.joint_names.size(), static_cast<std::size_t>(c.joints));
  EXPECT_EQ(model.shape_count(), c.shape);
  EXPECT_EQ(model.expression_count, c.expression);
  EXPECT_EQ(model.gender, c.gender);
  if (std::string(c.expected) == "SMPLH_NEUTRAL") {
    const FileBytes dmpl(smpl_file("dmpl.npz"));
    add_dmpl(model, dmpl.bytes(), "dmpl.npz");
    EXPECT_EQ(model.dmpl_count, 8);
  }
  const Expected expected(c.expected, model.beta_count());
  EXPECT_LT(farthest(posed_vertices<double>(model, expected.state), expected.vertices), 1e-5);
  EXPECT_LT(farthest(posed_vertices<float>(model, expected.state).cast<double>(), expected.vertices), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Families, SmplFiles,
    ::testing::Values(
        FileCase{"basicmodel_f_lbs_10_207_0_v1.1.0.pkl", "basicmodel_f_lbs_10_207_0_v1.1.0", "smpl", 6890,
                 13776, 24, 0, 10, 0, Gender::female},
        FileCase{"SMPL_MALE_300.pkl", "SMPL_MALE_300", "smpl", 6890, 13776, 24, 300, 300, 0, Gender::male},
        FileCase{"SMPLH_NEUTRAL.npz", "SMPLH_NEUTRAL", "smplh", 6890, 13776, 52, 0, 16, 0, Gender::neutral},
        FileCase{"SMPLX_NEUTRAL.npz", "SMPLX_NEUTRAL", "smplx", 10475, 20946, 55, 0, 16, 10, Gender::neutral},
        FileCase{"SMPLX_MALE.pkl", "SMPLX_MALE", "smplx", 10475, 20946, 55, 0, 10, 10, Gender::male},
        FileCase{"STAR_FEMALE.npz", "STAR_FEMALE", "star", 6890, 13776, 24, 0, 16, 0, Gender::female}));

/// The default body's own file, written in another format, is the same body.
TEST(SmplModel, TheDefaultBodySurvivesEveryFormat) {
  const BodyModel& body = default_body();
  SmplOptions all;
  all.betas = kEveryBeta;
  for (const char* name : {"own_smpl.pkl", "own_smpl.npz", "own_smplh.pkl"}) {
    const BodyModel model = read_smpl_file(name, all);
    ASSERT_EQ(model.vertex_count(), body.vertex_count()) << name;
    EXPECT_EQ(model.faces, body.faces) << name;
    EXPECT_EQ(model.shape_count(), body.beta_count()) << name;
    for (int pose = 0; pose < 5; ++pose) {
      const BodyState state = testing::test_state(7 * pose, static_cast<std::uint32_t>(pose));
      BodyState here = BodyState::rest(model);
      for (int j = 0; j < 24; ++j) here.rotation[model.joint_for_smpl(j)] = state.rotation[j];
      here.betas = state.betas;
      here.translation = state.translation;
      EXPECT_LT(farthest(posed_vertices<double>(model, here), posed_vertices<double>(body, state)), 1e-5)
          << name;
      const Points3d joints = pose_skeleton(model, here).joints, known = pose_skeleton(body, state).joints;
      for (int j = 0; j < 24; ++j)
        EXPECT_LT((joints.col(model.joint_for_smpl(j)) - known.col(j)).norm(), 1e-5)
            << name << " joint " << j;
    }
    int differing = 0;
    for (int v = 0; v < body.vertex_count(); ++v) differing += model.segment[v] != body.segment[v];
    EXPECT_LT(differing, body.vertex_count() / 100) << name << ": segments by weight are those of the maker";
  }
}

TEST(SmplModel, EverySegmentHasVerticesInEveryFamily) {
  for (const char* name : {"basicmodel_f_lbs_10_207_0_v1.1.0.pkl", "SMPLH_NEUTRAL.npz", "SMPLX_MALE.pkl"}) {
    const BodyModel model = read_smpl_file(name);
    std::array<int, 24> counts{};
    for (const std::uint8_t segment : model.segment) ++counts[segment];
    for (std::size_t s = 0; s < counts.size(); ++s)
      EXPECT_GT(counts[s], 10) << name << " " << kSegmentNames[s];
    EXPECT_EQ(model.joint_names[model.joint_for_smpl(22)],
              model.joint_count() > 24 ? "left_middle1" : "left_hand");
  }
}

TEST(SmplModel, HandPosesAreRead) {
  const BodyModel model = read_smpl_file("SMPLX_MALE.pkl");
  for (const HandPoses& hand : model.hands) {
    ASSERT_EQ(hand.mean.size(), 45);
    ASSERT_EQ(hand.components.cols(), 12);
    EXPECT_TRUE((hand.components.transpose() * hand.components).isIdentity(1e-9));
    EXPECT_NEAR(hand.deviation[0], 0.8, 0.25);
    EXPECT_LT(hand.deviation[11], hand.deviation[0]);
  }
}

TEST(SmplModel, MoreBetasThanThereAreAreWrongUsage) {
  SmplOptions options;
  options.betas = 11;
  try {
    read_smpl_file("basicmodel_f_lbs_10_207_0_v1.1.0.pkl", options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("has only 10"), std::string::npos) << error.what();
  }
}

TEST(SmplModel, SoftTissueOfAnotherMeshOrModelIsRefused) {
  const FileBytes dmpl(smpl_file("dmpl.npz"));
  BodyModel smplx = read_smpl_file("SMPLX_MALE.pkl");
  EXPECT_THROW(add_dmpl(smplx, dmpl.bytes(), "dmpl.npz"), Error);
  BodyModel own = read_smpl_file("own_smpl.npz");
  try {
    add_dmpl(own, dmpl.bytes(), "dmpl.npz");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_model);
    EXPECT_NE(std::string(error.what()).find("[6890, 3, 8]"), std::string::npos) << error.what();
  }
}

TEST(SmplModel, FilesThatAreNoModelSayWhatTheyHold) {
  for (const char* name : {"protocol2.pkl", "dmpl.npz", "vposer.expected.npz"}) {
    try {
      read_smpl_file(name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_model);
      EXPECT_NE(std::string(error.what()).find("no array 'v_template'"), std::string::npos) << error.what();
    }
  }
}

TEST(SmplModel, GenderIsReadFromNames) {
  EXPECT_EQ(gender_from_path("a/SMPLX_FEMALE.npz"), Gender::female);
  EXPECT_EQ(gender_from_path("basicModel_m_lbs_10_207_0_v1.0.0.pkl"), Gender::male);
  EXPECT_EQ(gender_from_path("smplh/neutral/model.npz"), Gender::neutral);
  EXPECT_EQ(gender_from_path("female/SMPLH_male.pkl"), Gender::male);
  EXPECT_EQ(gender_from_path("model.npz"), std::nullopt);
}

}  // namespace
}  // namespace vitruvian
