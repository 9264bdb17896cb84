#include "smpl/families.h"

#include <algorithm>

#include "io/text_cursor.h"

namespace vitruvian {
namespace {

constexpr int kBodyJoints = 22, kFingers = 15, kHeadSegment = 15, kLeftIndexSegment = 22,
              kRightIndexSegment = 23;

std::optional<Gender> gender_of(std::string_view part) {
  const std::string name = lower_case(part);
  const auto says = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  if (says("female") || says("_f_")) return Gender::female;
  if (says("male") || says("_m_")) return Gender::male;
  if (says("neutral")) return Gender::neutral;
  return std::nullopt;
}

}  // namespace

std::optional<SmplFamily> smpl_family(std::size_t joints, std::size_t pose_columns) {
  static const SmplFamily kFamilies[] = {{"smpl", 24, 207, -1, -1, -1},
                                         {"star", 24, 93, -1, -1, -1},
                                         {"smplh", 52, 459, 22, 37, -1},
                                         {"smplx", 55, 486, 25, 40, 22}};
  for (const SmplFamily& family : kFamilies) {
    if (static_cast<std::size_t>(family.joints) == joints &&
        static_cast<std::size_t>(family.pose_columns) == pose_columns)
      return family;
  }
  return std::nullopt;
}

std::vector<std::string> joint_names(const SmplFamily& family) {
  const int own = family.first_left_finger < 0 ? static_cast<int>(kSmplJointNames.size()) : kBodyJoints;
  std::vector<std::string> names(kSmplJointNames.begin(), kSmplJointNames.begin() + own);
  if (family.jaw >= 0) {
    for (const char* name : {"jaw", "left_eye_smplhf", "right_eye_smplhf"}) names.emplace_back(name);
  }
  if (family.first_left_finger < 0) return names;
  for (const char* side : {"left_", "right_"}) {
    for (const char* finger : {"index", "middle", "pinky", "ring", "thumb"}) {
      for (const char* number : {"1", "2", "3"}) names.push_back(std::string(side) + finger + number);
    }
  }
  return names;
}

int segment_of_joint(const SmplFamily& family, int joint) {
  if (joint < kBodyJoints || family.first_left_finger < 0) return joint;
  if (joint >= family.first_left_finger && joint < family.first_left_finger + kFingers)
    return kLeftIndexSegment;
  if (joint >= family.first_right_finger && joint < family.first_right_finger + kFingers)
    return kRightIndexSegment;
  return kHeadSegment;
}

std::optional<Gender> gender_from_path(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  if (slash == std::string_view::npos) return gender_of(path);
  if (const auto gender = gender_of(path.substr(slash + 1))) return gender;
  const std::string_view folder = path.substr(0, slash);
  const std::size_t before = folder.find_last_of("/\\");
  return gender_of(before == std::string_view::npos ? folder : folder.substr(before + 1));
}

}  // namespace vitruvian
