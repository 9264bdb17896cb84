#include "cli/measure_command.h"

#include <Eigen/LU>
#include <filesystem>
#include <optional>

#include "base/sha256.h"
#include "cli/model_loading.h"
#include "cli/paths.h"
#include "geometry/mesh.h"
#include "io/file.h"
#include "io/npz.h"
#include "measured/export_files.h"
#include "pipeline/prepared_scan.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

void check_model(const Registration& registration, const BodyModel& body, const MeasureArguments& arguments) {
  const std::optional<FileInfo>& tissue = registration.model.dmpl;
  if (tissue && arguments.dmpl_file.empty()) {
    throw Error(ErrorCode::usage, arguments.registration_file + ": was made with the soft tissue " +
                                      tissue->file + ": give it too, --dmpl FILE");
  }
  if (tissue && tissue->sha256 != file_info(arguments.dmpl_file).sha256) {
    throw Error(ErrorCode::usage, arguments.dmpl_file + ": is not the soft tissue of " +
                                      arguments.registration_file + " (" + tissue->file +
                                      "): its sha256 differs");
  }
  if (registration.model.sha256 == body.sha256) return;
  throw Error(ErrorCode::usage,
              arguments.registration_file + ": was made with the model " + registration.model.name +
                  " (sha256 " + registration.model.sha256.substr(0, 12) + "...), this one is " + body.name +
                  " (" + body.sha256.substr(0, 12) + "...): give the model it was made with, --model FILE");
}

/// Distances between the registered body and its scan, vertex by vertex.
SurfaceMeasurement compare_with_scan(const MeasureArguments& arguments, const Registration& registration,
                                     const Figure& figure, const Execution& execution) {
  Scan scan = read_scan_file(arguments.scan_file, execution);
  if (scan.sha256 != registration.scan.sha256) {
    throw Error(ErrorCode::usage, arguments.scan_file + ": is not the scan that was registered (" +
                                      registration.scan.file + "): its sha256 differs");
  }
  const PreparedScan prepared(std::move(scan), execution);
  const PlacedScan placed(prepared, registration.alignment.body_from_scan, execution);
  const BodyModel& body = figure.model->body();
  const Points3f vertices = figure.vertices.cast<float>(), normals = vertex_normals(vertices, body.faces);
  return measure_surface({vertices, normals, body.faces, body.segment}, placed.surface(), execution);
}

/// The vertex offsets beside a registration that has some, 3 x V; else empty.
/// @throws Error(bad_file, cannot_read).
Points3d rest_offsets(const MeasureArguments& arguments, const Registration& registration,
                      const BodyModel& body) {
  const std::string& name = registration.parameters->offsets_file;
  if (name.empty()) return Points3d(3, 0);
  const std::filesystem::path file_name(name);
  if (file_name.filename() != file_name) {
    throw Error(ErrorCode::bad_file, arguments.registration_file +
                                         ": parameters.offsets: the name of a file beside it is expected");
  }
  const std::string path =
      (std::filesystem::path(arguments.registration_file).parent_path() / file_name).string();
  const FileBytes file(path);
  const NumericArray array = NpzFile(file.bytes(), path).array("offsets");
  const auto count = static_cast<std::size_t>(body.vertex_count());
  if (array.shape != std::vector<std::size_t>{count, 3}) {
    throw Error(ErrorCode::bad_file, path + ": offsets must be " + std::to_string(count) + " x 3");
  }
  const Points3d offsets = Eigen::Map<const Points3d>(array.values.data(), 3, body.vertex_count());
  if (!offsets.allFinite())
    throw Error(ErrorCode::bad_file, path + ": offsets hold a number that is not finite");
  return offsets;
}

void add_sections(MeasuredRegistration& measured, const MeasureArguments& arguments) {
  for (const SectionRequest& request : arguments.sections) {
    measured.add_section(section_at(measured.scanned(), request));
  }
  for (const ProfileRequest& request : arguments.profiles) {
    for (const SectionResult& section : section_profile(measured.scanned(), request.segment, request.count)) {
      measured.add_section(section);
    }
  }
}

}  // namespace

ExitStatus run_measure(const MeasureArguments& arguments, const CliContext& context) {
  if (!arguments.exports.empty() && arguments.out.empty()) {
    throw Error(ErrorCode::usage, "--export needs --out DIR\nRun: vitruvian help measure");
  }
  Registration registration;
  std::string sha256_text;
  try {
    const FileBytes file(arguments.registration_file);
    const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
    registration = parse_registration(text, arguments.registration_file);
    sha256_text = to_hex(sha256(file.bytes()));
  } catch (const Error& error) {
    context.error << "vitruvian: " << error.what() << "\n";
    return ExitStatus::unreadable;
  }
  if (!registration.parameters) {
    context.error << "vitruvian: " << arguments.registration_file
                  << ": the registration failed and has no body to measure\n";
    return ExitStatus::not_all_ok;
  }
  const BodyModel body = context.open_body(arguments.model_file, arguments.dmpl_file);
  check_model(registration, body, arguments);

  std::optional<MeasuredRegistration> measured;
  try {
    measured.emplace(registration, body, rest_offsets(arguments, registration, body), sha256_text);
    if (!arguments.scan_file.empty()) {
      measured->compare(compare_with_scan(arguments, registration, measured->scanned(), context.interrupt));
    }
  } catch (const Error& error) {
    if (error.code() == ErrorCode::usage || error.code() == ErrorCode::cancelled) throw;
    context.error << "vitruvian: " << error.what() << "\n";
    return ExitStatus::unreadable;
  }
  add_sections(*measured, arguments);
  context.interrupt.check();

  const std::string json = measurements_json(measured->report(), JsonStyle::pretty);
  if (arguments.out.empty()) {
    context.out << json;
    return ExitStatus::ok;
  }
  make_folders(arguments.out);
  const auto path = [&](const char* name) { return (std::filesystem::path(arguments.out) / name).string(); };
  write_file(path("measurements.csv"), measurements_csv(measured->report()));
  write_file(path("measurements.json"), json);
  for (const std::string& format : arguments.exports) {
    for (const ExportedFile& file : export_files(format, *measured))
      write_file(path(file.name.c_str()), file.content);
    context.interrupt.check();
  }
  context.out << "Written  " << printable(arguments.out) << "\n";
  return ExitStatus::ok;
}

}  // namespace vitruvian
