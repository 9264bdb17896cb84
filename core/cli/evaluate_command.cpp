#include "cli/evaluate_command.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/file.h"
#include "measure/joint_error.h"
#include "pipeline/result_json_keypoints.h"
#include "pipeline/result_json_value.h"

namespace vitruvian {
namespace {

std::string text_of(const std::string& path) {
  const FileBytes file(path);
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

double micrometres(double mm) { return std::round(mm * 1e3) / 1e3; }

}  // namespace

ExitStatus run_evaluate(const EvaluateArguments& arguments, const CliContext& context) {
  const JointTruth truth = parse_truth(text_of(arguments.truth_file), arguments.truth_file);
  Registration registration;
  try {
    registration = parse_registration(text_of(arguments.registration_file), arguments.registration_file);
  } catch (const Error& error) {
    context.error << "vitruvian: " << error.what() << "\n";
    return ExitStatus::unreadable;
  }
  if (registration.joints.empty()) {
    context.error << "vitruvian: " << arguments.registration_file
                  << ": the registration failed and has no joints\n";
    return ExitStatus::not_all_ok;
  }
  JointPositions found;
  for (const RegisteredJoint& joint : registration.joints) found[joint.name] = joint.scan;
  // The truth's unit is certain; the registration's may be a guess.
  const double mm_per_unit = 1e3 * metres_per_unit(truth.unit);
  const JointErrors errors = pelvis_aligned_errors(found, truth.joints, mm_per_unit);

  nlohmann::ordered_json joints = nlohmann::ordered_json::object();
  for (const JointError& error : errors.joints) joints[error.joint] = micrometres(error.error_mm);
  nlohmann::ordered_json document;
  document["registration"] = arguments.registration_file;
  document["e_max_mm"] = micrometres(errors.max_mm);
  document["worst_joint"] = errors.worst;
  document["mean_mm"] = micrometres(errors.mean_mm);
  try {
    document["core_max_mm"] = micrometres(core_joint_errors(found, truth.joints, mm_per_unit).max_mm);
  } catch (const Error&) {
    document["core_max_mm"] = nullptr;
  }
  document["joints_mm"] = std::move(joints);
  context.out << json_text(document, JsonStyle::pretty);
  return ExitStatus::ok;
}

}  // namespace vitruvian
