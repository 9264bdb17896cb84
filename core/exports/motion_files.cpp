#include "exports/motion_files.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/npz.h"

namespace vitruvian {
namespace {

constexpr int kBodyJoints = 22, kHandJoints = 15, kFaceJoints = 3;
constexpr std::size_t kAmassPose = 156, kAmassDmpls = 8;

/// The linear coefficients without expression and soft tissue.
Eigen::VectorXd shape_of(const ExportedBody& body) {
  return body.state.betas.head(std::min<Index>(body.state.betas.size(), body.model.shape_count()));
}

/// The expression coefficients; none of a model without a face.
Eigen::VectorXd expression_of(const ExportedBody& body) {
  if (body.state.betas.size() != body.model.beta_count()) return {};
  return body.state.betas.segment(body.model.shape_count(), body.model.expression_count);
}

/// The fingers of the left hand, then those of the right (3 x 30); none of a model that has none.
Points3d fingers_of(const ExportedBody& body, const Points3d& pose) {
  const Index begin = kBodyJoints + (body.model.family == "smplx" ? kFaceJoints : 0);
  const bool has_hands = body.model.family == "smplx" || body.model.family == "smplh";
  if (!has_hands || pose.cols() != begin + 2 * kHandJoints) return Points3d(3, 0);
  return pose.rightCols(2 * kHandJoints);
}

std::string number(double value, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  for (char& c : text) {
    if (c == ',') c = '.';  // the decimal point of the caller's locale
  }
  return text;
}

Mat3d amass_from_body() { return (Mat3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished(); }

}  // namespace

std::string to_amass_npz(const ExportedBody& body) {
  BodyState turned = body.state;
  const Mat3d turn = amass_from_body();
  turned.rotation[0] = turn * body.state.rotation[0];
  // The root turns about the rest pelvis, which stays where it is in the model's own frame.
  const Vec3d pelvis = pose_skeleton(body.model, body.state).rest_joints.col(0);
  const Vec3d translation = turn * (pelvis + body.state.translation) - pelvis;
  const Points3d pose = turned.axis_angle();
  std::vector<double> poses(kAmassPose, 0);
  for (Index j = 0; j < std::min<Index>(kBodyJoints, pose.cols()); ++j) {
    for (int k = 0; k < 3; ++k) poses[static_cast<std::size_t>(3 * j + k)] = pose(k, j);
  }
  const Points3d fingers = fingers_of(body, pose);
  std::copy_n(fingers.data(), fingers.size(), poses.begin() + 3 * kBodyJoints);
  const std::vector<double> trans(translation.data(), translation.data() + 3), rate = {30};
  const Eigen::VectorXd shape = shape_of(body);
  const std::vector<double> betas(shape.data(), shape.data() + shape.size());
  std::vector<double> dmpls(kAmassDmpls, 0);
  if (body.state.betas.size() == body.model.beta_count()) {
    const Index count = std::min<Index>(kAmassDmpls, body.model.dmpl_count);
    Eigen::Map<Eigen::VectorXd>(dmpls.data(), count) =
        body.state.betas.segment(body.model.beta_count() - body.model.dmpl_count, count);
  }
  std::vector<NpzItem> items(6);
  items[0] = {.name = "poses", .shape = {1, kAmassPose}, .doubles = poses};
  items[1] = {.name = "trans", .shape = {1, 3}, .doubles = trans};
  items[2] = {.name = "betas", .shape = {betas.size()}, .doubles = betas};
  items[3] = {.name = "dmpls", .shape = {1, kAmassDmpls}, .doubles = dmpls};
  const std::string gender(name_of(body.gender));
  items[4] = {.name = "gender", .shape = {}, .text = gender};
  items[5] = {.name = "mocap_framerate", .shape = {}, .doubles = rate};
  return to_npz(items);
}

std::string to_smpl_codec(const ExportedBody& body) {
  const std::int32_t version = body.model.family == "smplx" ? 2 : body.model.family == "smplh" ? 1 : 0;
  const std::int32_t gender = body.gender == Gender::male ? 1 : body.gender == Gender::female ? 2 : 0;
  const Points3d pose = body.state.axis_angle();
  // SMPL has 24 body joints, its successors 22 and hands.
  const Index joints = std::min<Index>(version == 0 ? 24 : kBodyJoints, pose.cols());
  const Points3f rounded = pose.leftCols(joints).cast<float>();
  const Eigen::VectorXf betas = shape_of(body).cast<float>();
  const Vec3f translation = body.state.translation.cast<float>();
  const std::vector<std::int32_t> codec = {2}, smpl = {version}, sex = {gender}, frames = {1};
  const std::vector<float> rate = {30};
  const auto view = [](const auto& m) {
    return std::span<const float>(m.data(), static_cast<std::size_t>(m.size()));
  };
  const Points3f fingers = fingers_of(body, pose).cast<float>();
  const Points3f left = fingers.leftCols(fingers.cols() / 2), right = fingers.rightCols(fingers.cols() / 2);
  const Points3f face = version == 2 && fingers.cols() > 0
                            ? Points3f(pose.middleCols(kBodyJoints, kFaceJoints).cast<float>())
                            : Points3f(3, 0);
  const Eigen::VectorXf expression = expression_of(body).cast<float>();
  std::vector<NpzItem> items(8);
  items[0] = {.name = "codecVersion", .shape = {}, .integers = codec};
  items[1] = {.name = "smplVersion", .shape = {}, .integers = smpl};
  items[2] = {.name = "gender", .shape = {}, .integers = sex};
  items[3] = {
      .name = "shapeParameters", .shape = {static_cast<std::size_t>(betas.size())}, .floats = view(betas)};
  items[4] = {.name = "frameCount", .shape = {}, .integers = frames};
  items[5] = {.name = "frameRate", .shape = {}, .floats = rate};
  items[6] = {.name = "bodyTranslation", .shape = {1, 3}, .floats = view(translation)};
  items[7] = {.name = "bodyPose", .shape = {1, static_cast<std::size_t>(joints), 3}, .floats = view(rounded)};
  if (fingers.cols() > 0) {
    items.push_back({.name = "leftHandPose", .shape = {1, kHandJoints, 3}, .floats = view(left)});
    items.push_back({.name = "rightHandPose", .shape = {1, kHandJoints, 3}, .floats = view(right)});
  }
  if (face.cols() > 0)
    items.push_back({.name = "headPose", .shape = {1, kFaceJoints, 3}, .floats = view(face)});
  if (expression.size() > 0) {
    items.push_back({.name = "expressionParameters",
                     .shape = {static_cast<std::size_t>(expression.size())},
                     .floats = view(expression)});
  }
  return to_npz(items);
}

std::string to_trc(const ExportedBody& body, const std::string& file_name) {
  std::vector<NamedPoint> markers = body.landmarks;
  const Skeleton skeleton = pose_skeleton(body.model, body.state);
  for (Index j = 0; j < skeleton.joints.cols(); ++j) {
    markers.push_back(
        {"joint_" + body.model.joint_names[static_cast<std::size_t>(j)], skeleton.joints.col(j)});
  }
  const std::string count = std::to_string(markers.size());
  std::string out = "PathFileType\t4\t(X/Y/Z)\t" + file_name +
                    "\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
                    "OrigNumFrames\n30\t30\t1\t" +
                    count + "\tmm\t30\t1\t1\nFrame#\tTime";
  std::string axes = "\t", row = "1\t0";
  for (std::size_t m = 0; m < markers.size(); ++m) {
    out += "\t" + markers[m].name + "\t\t";
    const std::string index = std::to_string(m + 1);
    axes += "\tX" + index + "\tY" + index + "\tZ" + index;
    const Vec3d& p = markers[m].position;
    for (const double c : {p.z(), p.y(), -p.x()}) row += "\t" + number(1e3 * c, "%.4f");
  }
  return out + "\n" + axes + "\n\n" + row + "\n";
}

std::string to_subject_json(const ExportedBody& body) {
  nlohmann::ordered_json document;
  document["sex"] = body.gender == Gender::neutral ? "unknown" : std::string(name_of(body.gender));
  document["massKg"] = body.mass_kg;
  document["heightM"] = body.stature_m;
  return document.dump(2) + "\n";
}

std::string to_landmark_csv(const ExportedBody& body) {
  const Mat4d scan_from_body = body.body_from_scan.inverse();
  std::string out = "name,x,y,z\n";
  for (const NamedPoint& landmark : body.landmarks) {
    const Vec3d p =
        scan_from_body.topLeftCorner<3, 3>() * landmark.position + scan_from_body.topRightCorner<3, 1>();
    out += landmark.name;
    for (const double c : {p.x(), p.y(), p.z()}) out += "," + number(c, "%.9g");
    out += "\n";
  }
  return out;
}

}  // namespace vitruvian
