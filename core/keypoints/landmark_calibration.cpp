#include "keypoints/landmark_calibration.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace vitruvian {
namespace {

constexpr int kSmplJoints = 24;

/// Left landmark with its joint and candidate frames; `right` is its partner, or -1 for the nose.
struct Rule {
  int left, right, joint;
  std::vector<int> frames;
  double trust;
};

const std::vector<Rule>& rules() {
  static const std::vector<Rule> all = {
      {0, -1, 15, {15}, 0.7},    {7, 8, 15, {15}, 0.7},     {11, 12, 16, {13, 16, 9}, 1},
      {13, 14, 18, {16, 18}, 1}, {15, 16, 20, {18, 20}, 1}, {17, 18, 20, {20, 22}, 1},
      {19, 20, 20, {20, 22}, 1}, {23, 24, 1, {0, 1}, 1},    {25, 26, 4, {1, 4}, 1},
      {27, 28, 7, {4, 7}, 1},    {29, 30, 7, {7}, 1},       {31, 32, 10, {7, 10}, 1}};
  return all;
}

int mirrored_joint(int joint) {
  static constexpr int kMirror[kSmplJoints] = {0,  2,  1,  3,  5,  4,  6,  8,  7,  9,  11, 10,
                                               12, 14, 13, 15, 17, 16, 19, 18, 21, 20, 23, 22};
  return kMirror[joint];
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Offset of a landmark in each body where it was found.
std::vector<Vec3d> offsets_in_frame(std::span<const CalibrationBody> bodies, int landmark, int joint,
                                    int frame) {
  std::vector<Vec3d> offsets;
  for (const CalibrationBody& body : bodies) {
    const Landmark3d& found = body.landmarks[landmark];
    if (!(found.confidence > 0)) continue;
    offsets.push_back(body.rotations[frame].transpose() *
                      (found.position.cast<double>() - body.joints.col(joint)));
  }
  return offsets;
}

Vec3d robust_mean(const std::vector<Vec3d>& values) {
  constexpr double kScale = 0.03;
  Vec3d mean;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const Vec3d& value : values) coordinates.push_back(value[axis]);
    mean[axis] = median(std::move(coordinates));
  }
  for (int iteration = 0; iteration < 10; ++iteration) {
    Vec3d sum = Vec3d::Zero();
    double total = 0;
    for (const Vec3d& value : values) {
      const double weight = 1 / (1 + (value - mean).squaredNorm() / (kScale * kScale));
      sum += weight * value;
      total += weight;
    }
    mean = sum / total;
  }
  return mean;
}

/// Left and right observations with the right ones mirrored onto the left.
std::vector<Vec3d> folded(std::span<const CalibrationBody> bodies, const Rule& rule, int frame) {
  std::vector<Vec3d> values = offsets_in_frame(bodies, rule.left, rule.joint, frame);
  if (rule.right >= 0) {
    for (Vec3d value :
         offsets_in_frame(bodies, rule.right, mirrored_joint(rule.joint), mirrored_joint(frame))) {
      value.x() = -value.x();
      values.push_back(value);
    }
  }
  return values;
}

double median_distance(const std::vector<Vec3d>& values, const Vec3d& centre) {
  std::vector<double> distances;
  for (const Vec3d& value : values) distances.push_back((value - centre).norm());
  return median(std::move(distances));
}

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
  throw Error(ErrorCode::bad_model, file + ": " + what + "; build the models again or restore the file");
}

}  // namespace

Calibration calibrate_landmarks(std::span<const CalibrationBody> bodies) {
  for (const CalibrationBody& body : bodies) {
    if (body.landmarks.size() != kLandmarkCount || body.joints.cols() < kSmplJoints ||
        body.rotations.size() < kSmplJoints) {
      throw Error(ErrorCode::internal, "a calibration body lacks landmarks, joints or rotations");
    }
  }
  constexpr double kReference = 0.02, kBest = 0.01, kLeastWeight = 0.3, kLargestWeight = 1.2;
  Calibration calibration;
  for (const Rule& rule : rules()) {
    double best_median = 0;
    int best_frame = -1;
    Vec3d best_offset = Vec3d::Zero();
    std::vector<Vec3d> best_values;
    for (const int frame : rule.frames) {
      std::vector<Vec3d> values = folded(bodies, rule, frame);
      if (values.empty()) {
        throw Error(ErrorCode::internal, "no calibration body shows landmark " + std::to_string(rule.left));
      }
      Vec3d offset = robust_mean(values);
      if (rule.right < 0) offset.x() = 0;
      const double spread = median_distance(values, offset);
      if (best_frame < 0 || spread < best_median) {
        best_median = spread;
        best_frame = frame;
        best_offset = offset;
        best_values = std::move(values);
      }
    }
    const double weight =
        rule.trust * std::clamp(kReference / std::max(best_median, kBest), kLeastWeight, kLargestWeight);
    const double uncalibrated = median_distance(best_values, Vec3d::Zero());
    calibration.offsets.push_back({rule.left, rule.joint, best_frame, best_offset, weight});
    calibration.residuals.push_back({rule.left, best_median, uncalibrated});
    if (rule.right >= 0) {
      const Vec3d mirrored(-best_offset.x(), best_offset.y(), best_offset.z());
      calibration.offsets.push_back(
          {rule.right, mirrored_joint(rule.joint), mirrored_joint(best_frame), mirrored, weight});
      calibration.residuals.push_back({rule.right, best_median, uncalibrated});
    }
  }
  return calibration;
}

std::string landmarks_to_json(std::span<const LandmarkOffset> offsets) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LandmarkOffset& entry : offsets) {
    list.push_back({{"landmark", entry.landmark},
                    {"joint", entry.joint},
                    {"frame_joint", entry.frame_joint},
                    {"offset_m", {entry.offset.x(), entry.offset.y(), entry.offset.z()}},
                    {"weight", entry.weight}});
  }
  return nlohmann::ordered_json{{"landmarks", std::move(list)}}.dump(1) + "\n";
}

std::vector<LandmarkOffset> landmarks_from_json(const std::string& text, const std::string& file) {
  constexpr double kFarthest = 1.0, kHeaviest = 100.0;
  const nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (root.is_discarded()) refuse(file, "not JSON");
  if (!root.is_object() || !root.contains("landmarks") || !root["landmarks"].is_array()) {
    refuse(file, "no array \"landmarks\"");
  }
  std::vector<LandmarkOffset> offsets;
  for (const nlohmann::json& entry : root["landmarks"]) {
    const std::string place = "entry " + std::to_string(offsets.size()) + ": ";
    const auto number = [&](const nlohmann::json& value, const char* name, double low, double high) {
      if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high)) {
        refuse(file, place + name + " is missing or out of range");
      }
      return value.get<double>();
    };
    const auto index = [&](const char* name, int count) {
      if (!entry.is_object() || !entry.contains(name) || !entry[name].is_number_integer()) {
        refuse(file, place + name + " is missing or not an integer");
      }
      return static_cast<int>(number(entry[name], name, 0, count - 1));
    };
    LandmarkOffset offset;
    offset.landmark = index("landmark", kLandmarkCount);
    offset.joint = index("joint", kSmplJoints);
    offset.frame_joint = index("frame_joint", kSmplJoints);
    if (!entry.contains("offset_m") || !entry["offset_m"].is_array() || entry["offset_m"].size() != 3) {
      refuse(file, place + "offset_m is not three numbers");
    }
    for (int axis = 0; axis < 3; ++axis) {
      offset.offset[axis] = number(entry["offset_m"][axis], "offset_m", -kFarthest, kFarthest);
    }
    offset.weight = number(entry.value("weight", nlohmann::json()), "weight", 0, kHeaviest);
    offsets.push_back(offset);
  }
  if (offsets.empty()) refuse(file, "no landmark in it");
  return offsets;
}

}  // namespace vitruvian
