#include "cli/measure_command.h"

#include <filesystem>

#include "base/sha256.h"
#include "cli/paths.h"
#include "io/file.h"
#include "pipeline/measurements_json.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

void check_model(const Registration& registration, const BodyModel& body, const MeasureArguments& arguments) {
  const BodyParameters& parameters = *registration.parameters;
  if (registration.model.sha256 == body.sha256 && parameters.pose.cols() == body.joint_count() &&
      parameters.betas.size() <= body.beta_count()) {
    return;
  }
  throw Error(ErrorCode::usage,
              arguments.registration_file + ": was made with the model " + registration.model.name +
                  " (sha256 " + registration.model.sha256.substr(0, 12) + "...), this one is " + body.name +
                  " (" + body.sha256.substr(0, 12) + "...): give the model it was made with, --model FILE");
}

std::vector<SectionResult> wanted_sections(const Figure& figure, const MeasureArguments& arguments) {
  std::vector<SectionResult> sections;
  for (const SectionRequest& request : arguments.sections) sections.push_back(section_at(figure, request));
  for (const ProfileRequest& request : arguments.profiles) {
    const std::vector<SectionResult> profile = section_profile(figure, request.segment, request.count);
    sections.insert(sections.end(), profile.begin(), profile.end());
  }
  return sections;
}

}  // namespace

ExitStatus run_measure(const MeasureArguments& arguments, const CliContext& context) {
  if (!arguments.scan_file.empty()) {
    throw Error(ErrorCode::not_available, "--scan: not yet available in this version");
  }
  Registration registration;
  MeasurementReport report;
  try {
    const FileBytes file(arguments.registration_file);
    const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
    registration = parse_registration(text, arguments.registration_file);
    report.registration_sha256 = to_hex(sha256(file.bytes()));
  } catch (const Error& error) {
    context.error << "vitruvian: " << error.what() << "\n";
    return ExitStatus::unreadable;
  }
  if (!registration.parameters) {
    context.error << "vitruvian: " << arguments.registration_file
                  << ": the registration failed and has no body to measure\n";
    return ExitStatus::not_all_ok;
  }
  const BodyModel body = context.open_body(arguments.model_file);
  check_model(registration, body, arguments);

  const BodyParameters& parameters = *registration.parameters;
  const MeasuredModel measured(body);
  const Figure figure(
      measured, BodyState::from_axis_angle(parameters.pose, parameters.betas, parameters.translation_m));
  report.body = measure_body(figure);
  report.sections = wanted_sections(figure, arguments);
  context.interrupt.check();

  const std::string json = measurements_json(report, JsonStyle::pretty);
  if (arguments.out.empty()) {
    context.out << json;
    return ExitStatus::ok;
  }
  make_folders(arguments.out);
  const auto path = [&](const char* name) { return (std::filesystem::path(arguments.out) / name).string(); };
  write_file(path("measurements.csv"), measurements_csv(report));
  write_file(path("measurements.json"), json);
  context.out << "Written  " << printable(arguments.out) << "\n";
  return ExitStatus::ok;
}

}  // namespace vitruvian
