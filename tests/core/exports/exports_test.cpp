#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "core/body/random_model.h"
#include "exports/html_report.h"
#include "exports/motion_files.h"
#include "exports/skinned_glb.h"
#include "io/npz.h"

namespace vitruvian {
namespace {

using nlohmann::json;

std::span<const std::byte> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

/// A GLB taken apart by the format's own rules.
struct Glb {
  json document;
  std::string binary;
  explicit Glb(const std::string& file) {
    const auto word = [&](std::size_t at) {
      std::uint32_t value;
      std::memcpy(&value, file.data() + at, 4);
      return value;
    };
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), file.size());
    const std::uint32_t length = word(12);
    EXPECT_EQ(length % 4, 0u);
    document = json::parse(file.substr(20, length));
    binary = file.substr(28 + length);
    EXPECT_EQ(word(20 + length), binary.size());
  }
  template <typename T>
  std::vector<T> accessor(int index) const {
    const json& a = document["accessors"][index];
    const json& view = document["bufferViews"][a["bufferView"].get<int>()];
    std::vector<T> values(view["byteLength"].get<std::size_t>() / sizeof(T));
    std::memcpy(values.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                values.size() * sizeof(T));
    return values;
  }
};

struct Sample {
  BodyModel model = testing::random_model(3, 24, 60, 5, 6);
  ExportedBody body{model,
                    testing::random_state(model, 4),
                    Gender::female,
                    Mat4d::Identity(),
                    {{"sellion", Vec3d(0.1, 1.5, 0.2)}, {"left_asis", Vec3d(-0.1, 1, 0.3)}},
                    1.7,
                    60};
  Sample() { body.body_from_scan << 0, 0.001, 0, 1, 0, 0, 0.001, 2, 0.001, 0, 0, 3, 0, 0, 0, 1; }
};

TEST(SkinnedGlb, SkinnedByItsOwnDataGivesTheRegisteredMesh) {
  const Sample sample;
  const Glb glb(to_skinned_glb(sample.body));
  const json& primitive = glb.document["meshes"][0]["primitives"][0];
  const json& nodes = glb.document["nodes"];
  const json& skin = glb.document["skins"][0];
  const auto bind = glb.accessor<float>(skin["inverseBindMatrices"]);
  // World transforms as a viewer makes them, with the rotations of the animation's first key.
  std::vector<Mat4d> world(nodes.size(), Mat4d::Identity());
  std::vector<Eigen::Quaterniond> turn(nodes.size(), Eigen::Quaterniond::Identity());
  for (const json& channel : glb.document["animations"][0]["channels"]) {
    const json& sampler = glb.document["animations"][0]["samplers"][channel["sampler"].get<int>()];
    const auto keys = glb.accessor<float>(sampler["output"]);
    ASSERT_EQ(keys.size(), 8u);
    turn[channel["target"]["node"].get<std::size_t>()] =
        Eigen::Quaterniond(keys[3], keys[0], keys[1], keys[2]);
  }
  const std::function<void(std::size_t, const Mat4d&)> visit = [&](std::size_t n, const Mat4d& parent) {
    const json& node = nodes[n];
    Mat4d local = Mat4d::Identity();
    if (node.contains("translation")) {
      for (int k = 0; k < 3; ++k) local(k, 3) = node["translation"][static_cast<std::size_t>(k)];
      local.topLeftCorner<3, 3>() = turn[n].toRotationMatrix();
      const json& r = node["rotation"];
      const double keyed[] = {turn[n].x(), turn[n].y(), turn[n].z(), turn[n].w()};
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(r[k].get<double>(), keyed[k], 1e-6) << "the pose at rest too";
    }
    world[n] = parent * local;
    if (node.contains("children")) {
      for (const json& child : node["children"]) visit(child, world[n]);
    }
  };
  for (const json& root : glb.document["scenes"][0]["nodes"]) visit(root, Mat4d::Identity());

  const auto positions = glb.accessor<float>(primitive["attributes"]["POSITION"]);
  const Points3d posed = posed_vertices<double>(sample.model, sample.body.state);
  Points3d skinned = Points3d::Zero(3, posed.cols());
  for (int set = 0; set < 2; ++set) {
    const auto joints = glb.accessor<std::uint16_t>(primitive["attributes"]["JOINTS_" + std::to_string(set)]);
    const auto weights = glb.accessor<float>(primitive["attributes"]["WEIGHTS_" + std::to_string(set)]);
    for (Index v = 0; v < posed.cols(); ++v) {
      const Eigen::Vector4d rest(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2], 1);
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t i = 4 * static_cast<std::size_t>(v) + k;
        const Mat4d inverse = Eigen::Map<const Eigen::Matrix4f>(bind.data() + 16 * joints[i]).cast<double>();
        skinned.col(v) +=
            weights[i] * (world[skin["joints"][joints[i]].get<std::size_t>()] * inverse * rest).head<3>();
      }
    }
  }
  EXPECT_LT((skinned - posed).colwise().norm().maxCoeff(), 1e-5);
  EXPECT_EQ(glb.accessor<std::uint32_t>(primitive["indices"]).size(),
            static_cast<std::size_t>(sample.model.faces.size()));
  EXPECT_EQ(nodes[1]["extras"]["scan_from_glb"].size(), 16u);
}

TEST(MotionFiles, AmassIsTheSameBodyWithZUp) {
  const Sample sample;
  const std::string file = to_amass_npz(sample.body);
  const NpzFile npz(bytes_of(file), "amass.npz");
  EXPECT_EQ(npz.array("poses").shape, (std::vector<std::size_t>{1, 156}));
  EXPECT_EQ(npz.array("trans").shape, (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(npz.array("dmpls").shape, (std::vector<std::size_t>{1, 8}));
  EXPECT_EQ(npz.text("gender"), "female");
  EXPECT_EQ(npz.array("mocap_framerate").shape.size(), 0u);
  const std::vector<double> poses = npz.array("poses").values, trans = npz.array("trans").values;
  // The reader's body: hands (joints 22, 23) are not in the file, so they are taken from ours.
  Points3d pose = sample.body.state.axis_angle();
  for (Index i = 0; i < 66; ++i) pose.data()[i] = poses[static_cast<std::size_t>(i)];
  const Points3d read = posed_vertices<double>(
      sample.model,
      BodyState::from_axis_angle(pose, sample.body.state.betas, Vec3d(trans[0], trans[1], trans[2])));
  const Points3d own = posed_vertices<double>(sample.model, sample.body.state);
  for (Index v = 0; v < own.cols(); ++v) {
    EXPECT_LT((read.col(v) - Vec3d(own(0, v), -own(2, v), own(1, v))).norm(), 1e-6);
  }
}

TEST(MotionFiles, SmplCodec) {
  const Sample sample;
  const std::string file = to_smpl_codec(sample.body);
  const NpzFile npz(bytes_of(file), "body.smpl");
  EXPECT_EQ(npz.array("bodyPose").shape, (std::vector<std::size_t>{1, 24, 3}));
  EXPECT_EQ(npz.array("shapeParameters").values.size(), 5u);
  EXPECT_EQ(npz.array("gender").values, std::vector<double>{2});
  EXPECT_NEAR(npz.array("bodyTranslation").values[1], sample.body.state.translation.y(), 1e-6);
}

TEST(MotionFiles, KeepHandsAndFaceWhereTheFormatHasThem) {
  const auto values = [](const Points3d& points) {
    return std::vector<double>(points.data(), points.data() + points.size());
  };
  const auto near = [](const std::vector<double>& found, const std::vector<double>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
  };
  for (const auto& [family, joints, expressions] :
       std::vector<std::tuple<std::string, int, int>>{{"smplh", 52, 0}, {"smplx", 55, 3}}) {
    SCOPED_TRACE(family);
    BodyModel model = testing::random_model(5, joints, 120, 8, 6);
    model.family = family;
    model.expression_count = expressions;
    const ExportedBody body{model, testing::random_state(model, 6)};
    const Points3d pose = body.state.axis_angle();
    const std::string codec_file = to_smpl_codec(body), amass_file = to_amass_npz(body);
    const NpzFile codec(bytes_of(codec_file), "body.smpl"), amass(bytes_of(amass_file), "amass.npz");
    EXPECT_EQ(codec.array("bodyPose").shape, (std::vector<std::size_t>{1, 22, 3}));
    EXPECT_EQ(codec.array("leftHandPose").shape, (std::vector<std::size_t>{1, 15, 3}));
    near(codec.array("leftHandPose").values, values(pose.middleCols(joints - 30, 15)));
    near(codec.array("rightHandPose").values, values(pose.rightCols(15)));
    const std::vector<double> poses = amass.array("poses").values;
    near({poses.begin() + 66, poses.end()}, values(pose.rightCols(30)));
    const Eigen::VectorXd betas = body.state.betas;
    const Index shapes = betas.size() - expressions;
    near(codec.array("shapeParameters").values, {betas.data(), betas.data() + shapes});
    EXPECT_EQ(codec.has("headPose"), expressions > 0);
    EXPECT_EQ(codec.has("expressionParameters"), expressions > 0);
    if (expressions == 0) continue;
    near(codec.array("headPose").values, values(pose.middleCols(22, 3)));
    near(codec.array("expressionParameters").values, {betas.data() + shapes, betas.data() + betas.size()});
  }
}

TEST(MotionFiles, MarkersForOpenSim) {
  const Sample sample;
  std::istringstream file(to_trc(sample.body, "x.trc"));
  std::vector<std::vector<std::string>> lines;
  for (std::string line; std::getline(file, line);) {
    lines.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, '\t');) lines.back().push_back(cell);
  }
  ASSERT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[2][3], "26") << "2 landmarks and 24 joints";
  EXPECT_EQ(lines[2][4], "mm");
  EXPECT_EQ(lines[3][2], "sellion");
  EXPECT_EQ(lines[3][5], "left_asis");
  EXPECT_EQ(lines[4][2], "X1");
  EXPECT_TRUE(lines[5].empty());
  ASSERT_EQ(lines[6].size(), 2u + 3 * 26);
  EXPECT_NEAR(std::stod(lines[6][2]), 200, 1e-9) << "forward";
  EXPECT_NEAR(std::stod(lines[6][3]), 1500, 1e-9) << "up";
  EXPECT_NEAR(std::stod(lines[6][4]), -100, 1e-9) << "right";
  const json subject = json::parse(to_subject_json(sample.body));
  EXPECT_EQ(subject["sex"], "female");
  EXPECT_EQ(subject["heightM"], 1.7);
}

TEST(MotionFiles, LandmarksInTheScansFrame) {
  const Sample sample;
  std::istringstream file(to_landmark_csv(sample.body));
  std::string head, row;
  std::getline(file, head);
  std::getline(file, row);
  EXPECT_EQ(head, "name,x,y,z");
  double x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(row.c_str(), "sellion,%lf,%lf,%lf", &x, &y, &z), 3);
  const Eigen::Vector4d body = sample.body.body_from_scan * Eigen::Vector4d(x, y, z, 1);
  EXPECT_LT((body.head<3>() - Vec3d(0.1, 1.5, 0.2)).norm(), 1e-5);
}

TEST(HtmlReport, EscapesAndStandsAlone) {
  const Sample sample;
  const Points3d vertices = posed_vertices<double>(sample.model, sample.body.state);
  const ReportContent content{"<b>&\"scan\"",
                              "ok",
                              {"a < b"},
                              {{"figure <", vertices, {{"tape", {Vec3d::Zero(), Vec3d::UnitY()}}}}},
                              sample.model.faces,
                              {{"Lengths & girths", "", {{"girth", "1.0", "0.1", "ISO", "round"}}}},
                              {{"arm <", "mm", "mm", {0, 1}, {{"girth", {1, 2}}}}},
                              {"not <i>"}};
  const std::string html = to_html_report(content);
  EXPECT_EQ(html.find("<b>&\""), std::string::npos);
  EXPECT_NE(html.find("&lt;b&gt;&amp;&quot;scan"), std::string::npos);
  EXPECT_NE(html.find("class=\"tape\""), std::string::npos);
  for (const char* foreign : {"http", "src=", "<script", "@import", "url("})
    EXPECT_EQ(html.find(foreign), std::string::npos);
  for (const char* raw : {"figure <", "Lengths & ", "arm <", "not <i>"})
    EXPECT_EQ(html.find(raw), std::string::npos) << raw;
  EXPECT_NE(html.find("<td>round</tr>"), std::string::npos) << "every row has its definition";
}

TEST(Plot, DrawsEachLineWithinItsFrameAndBreaksItWhereNothingIsKnown) {
  const double unknown = std::nan("");
  const Plot plot{"arm",
                  "mm",
                  "mm",
                  {0, 10, 20, 30, 40},
                  {{"girth", {200, 210, unknown, 250, 240}}, {"depth", {70, 71, 72, 73, 74}}}};
  const std::string svg = to_svg(plot);
  for (const char* text : {"nan", "inf"}) EXPECT_EQ(svg.find(text), std::string::npos);
  // The broken line is two pieces, the whole one one; each has a piece more in the legend.
  const std::string broken = svg.substr(svg.find("</g>"), svg.find("stroke=\"#c2185b\"") - svg.find("</g>"));
  const std::string d = broken.substr(broken.rfind("d=\"") + 3);
  EXPECT_EQ(std::count(d.begin(), d.end(), 'M'), 2) << d;
  double x = 0, y = 0;
  for (std::size_t at = 0; (at = d.find_first_of("ML", at)) != std::string::npos; ++at) {
    ASSERT_EQ(std::sscanf(d.c_str() + at + 1, "%lf %lf", &x, &y), 2);
    EXPECT_TRUE(x >= 0 && x <= 360 && y >= 0 && y <= 220) << d;
  }
  EXPECT_EQ(to_svg({"none", "", "", {0, 1}, {{"girth", {unknown, unknown}}}}), "");
  EXPECT_FALSE(to_svg({"flat", "", "", {5}, {{"girth", {3}}}}).empty());
}

}  // namespace
}  // namespace vitruvian
