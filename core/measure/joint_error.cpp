#include "measure/joint_error.h"

#include <array>
#include <span>
#include <string_view>

#include "base/error.h"
#include "body/model.h"

namespace vitruvian {
namespace {

constexpr std::size_t kEvaluatedJoints = 22;
constexpr std::array<std::string_view, 12> kCoreJoints = {
    "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
    "left_hip",      "right_hip",      "left_knee",  "right_knee",  "left_ankle", "right_ankle"};

struct Difference {
  std::string joint;
  Vec3d mm;  ///< registered minus truth
};

std::vector<Difference> differences(std::span<const std::string_view> names, const JointPositions& registered,
                                    const JointPositions& truth, double mm_per_unit) {
  std::vector<Difference> result;
  for (const std::string_view name : names) {
    const auto a = registered.find(std::string(name)), b = truth.find(std::string(name));
    if (a == registered.end() || b == truth.end()) continue;
    result.push_back({std::string(name), mm_per_unit * (a->second - b->second)});
  }
  return result;
}

JointErrors errors_about(const std::vector<Difference>& differences, const Vec3d& offset_mm) {
  JointErrors errors;
  for (const Difference& difference : differences) {
    const double distance = (difference.mm - offset_mm).norm();
    errors.joints.push_back({difference.joint, distance});
    errors.mean_mm += distance / static_cast<double>(differences.size());
    if (errors.worst.empty() || distance > errors.max_mm) {
      errors.max_mm = distance;
      errors.worst = difference.joint;
    }
  }
  return errors;
}

}  // namespace

JointErrors pelvis_aligned_errors(const JointPositions& registered, const JointPositions& truth,
                                  double mm_per_unit) {
  const std::span names(kSmplJointNames.data(), kEvaluatedJoints);
  const std::vector<Difference> all = differences(names, registered, truth, mm_per_unit);
  if (all.empty() || all.front().joint != kSmplJointNames[0]) {
    throw Error(ErrorCode::bad_file,
                "joint errors need the joint \"pelvis\" in the registration and in the truth");
  }
  if (all.size() < 2) {
    throw Error(ErrorCode::bad_file, "registration and truth share no joint but the pelvis");
  }
  return errors_about(all, all.front().mm);
}

JointErrors core_joint_errors(const JointPositions& registered, const JointPositions& truth,
                              double mm_per_unit) {
  const std::vector<Difference> core = differences(kCoreJoints, registered, truth, mm_per_unit);
  if (core.size() < 2) {
    throw Error(ErrorCode::bad_file, "registration and truth share fewer than two of the 12 core joints");
  }
  Vec3d mean = Vec3d::Zero();
  for (const Difference& difference : core) mean += difference.mm / static_cast<double>(core.size());
  return errors_about(core, mean);
}

}  // namespace vitruvian
