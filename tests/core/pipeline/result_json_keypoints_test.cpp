#include "pipeline/result_json_keypoints.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace vitruvian {
namespace {

std::string complaint_of(Mat4d (*read)(std::string_view, const std::string&), const std::string& text) {
  try {
    read(text, "f.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(KeypointsJson, RoundTrip) {
  const std::string text =
      R"({"frame":"body","joints":{"left_wrist":{"position":[1,2.5,-3]},"pelvis":{"position":[0,0,0.1],"confidence":0.5}}})";
  const KeypointSet keypoints = parse_keypoints(text, "k.json");
  EXPECT_EQ(keypoints.frame, KeypointFrame::body);
  ASSERT_EQ(keypoints.joints.size(), 2u);
  EXPECT_EQ(keypoints.joints.at("left_wrist").confidence, 1) << "the default";
  EXPECT_EQ(keypoints.joints.at("left_wrist").position, Vec3d(1, 2.5, -3));
  const std::string out = keypoints_json(keypoints, JsonStyle::compact);
  EXPECT_LT(out.find("pelvis"), out.find("left_wrist")) << "SMPL order";
  EXPECT_EQ(keypoints_json(parse_keypoints(out, "k"), JsonStyle::compact), out);
}

TEST(KeypointsJson, RefusesWhatIsWrong) {
  for (const char* text : {
           "",
           "[]",
           "{}",
           R"({"frame":"body"})",
           R"({"frame":"world","joints":{"pelvis":{"position":[0,0,0]}}})",
           R"({"frame":"body","joints":{}})",
           R"({"frame":"body","joints":[]})",
           R"({"frame":"body","joints":{"left_hand":{"position":[0,0,0]}}})",
           R"({"frame":"body","joints":{"pelvis":{"position":[0,0]}}})",
           R"({"frame":"body","joints":{"pelvis":{"position":[0,0,1e999]}}})",
           R"({"frame":"body","joints":{"pelvis":{"position":[0,0,null]}}})",
           R"({"frame":"body","joints":{"pelvis":{"position":[0,0,0],"confidence":2}}})",
       }) {
    SCOPED_TRACE(text);
    try {
      parse_keypoints(text, "k.json");
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_file);
      EXPECT_EQ(std::string(error.what()).rfind("k.json: ", 0), 0u) << error.what();
    }
  }
}

TEST(TruthJson, ReadsUnitsAndJoints) {
  const JointTruth truth = parse_truth(
      R"({"frame":"scan","unit":"in","joints":{"pelvis":[1,2,3],"tail":[4,5,6]},"about":{"name":"x"}})",
      "t.json");
  EXPECT_EQ(truth.unit, Unit::inch);
  EXPECT_EQ(truth.joints.at("pelvis"), Vec3d(1, 2, 3));
  EXPECT_EQ(truth.joints.size(), 2u);
  EXPECT_THROW(parse_truth(R"({"frame":"body","unit":"m","joints":{}})", "t"), Error);
  EXPECT_THROW(parse_truth(R"({"frame":"scan","unit":"auto","joints":{}})", "t"), Error);
  EXPECT_THROW(parse_truth(R"({"frame":"scan","unit":"m","joints":{"pelvis":[1,2]}})", "t"), Error);
}

TEST(AlignmentJson, TakesSimilaritiesOnly) {
  const std::string rows = "[[0,0.001,0,1],[0,0,0.001,2],[0.001,0,0,3],[0,0,0,1]]";
  EXPECT_EQ(parse_alignment(rows, "a")(1, 3), 2);
  EXPECT_EQ(parse_alignment("{\"body_from_scan\":" + rows + "}", "a")(2, 3), 3);
  EXPECT_NE(complaint_of(parse_alignment, "[[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]").find("mirrors"),
            std::string::npos);
  EXPECT_NE(complaint_of(parse_alignment, "[[1,0,0,0],[0,2,0,0],[0,0,1,0],[0,0,0,1]]").find("rotation"),
            std::string::npos);
  EXPECT_NE(complaint_of(parse_alignment, "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]").find("last row"),
            std::string::npos);
  EXPECT_NE(complaint_of(parse_alignment, "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]").find("four rows"),
            std::string::npos);
}

}  // namespace
}  // namespace vitruvian
