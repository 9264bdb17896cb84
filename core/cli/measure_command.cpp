#include "cli/measure_command.h"

#include <Eigen/LU>
#include <filesystem>
#include <optional>

#include "anthropometry/posture.h"
#include "base/sha256.h"
#include "cli/measure_exports.h"
#include "cli/paths.h"
#include "geometry/mesh.h"
#include "io/file.h"
#include "io/npz.h"
#include "pipeline/measurements_json.h"
#include "pipeline/prepared_scan.h"
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

/// The rows of surface_segments by segment.
std::array<const SegmentError*, kSegmentCount> error_rows(const Registration& registration) {
  std::array<const SegmentError*, kSegmentCount> rows{};
  if (!registration.surface_error) return rows;
  for (const SegmentError& row : registration.surface_error->surface_segments) {
    const int segment = segment_named(row.segment);
    if (segment >= 0) rows[static_cast<std::size_t>(segment)] = &row;
  }
  return rows;
}

FitErrors fit_errors(const Registration& registration) {
  const auto rows = error_rows(registration);
  FitErrors errors;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    if (rows[s] && rows[s]->statistics) errors[s] = 1e-3 * rows[s]->statistics->mean_mm;
  }
  return errors;
}

/// From the very vertices that the landmark lies between.
double local_confidence(const SurfaceLandmark& landmark, const SurfaceMeasurement& surface) {
  double observed = 0, error = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(landmark.vertex[k]);
    observed += landmark.weight[static_cast<Index>(k)] * surface.observed[v];
    error += landmark.weight[static_cast<Index>(k)] * surface.surface_distance_m[v];
  }
  return landmark_confidence(observed, error);
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

std::vector<LandmarkReport> landmark_reports(const Registration& registration, const Figure& figure,
                                             const LandmarkSet& landmarks,
                                             const SurfaceMeasurement* surface) {
  const auto rows = error_rows(registration);
  const Mat4d scan_from_body = registration.alignment.body_from_scan.inverse();
  std::vector<LandmarkReport> reports;
  for (const SurfaceLandmark& landmark : landmarks.all()) {
    LandmarkReport report{std::string(landmark.name), landmark.position(figure.vertices), Vec3d::Zero(),
                          std::nullopt};
    report.scan =
        scan_from_body.topLeftCorner<3, 3>() * report.body_m + scan_from_body.topRightCorner<3, 1>();
    if (surface) {
      report.confidence = local_confidence(landmark, *surface);
    } else if (const SegmentError* row = rows[static_cast<std::size_t>(landmark.segment)]) {
      report.confidence =
          row->statistics ? landmark_confidence(row->observed, 1e-3 * row->statistics->mean_mm) : 0.0;
    }
    reports.push_back(std::move(report));
  }
  return reports;
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
  if (!arguments.exports.empty() && arguments.out.empty()) {
    throw Error(ErrorCode::usage, "--export needs --out DIR\nRun: vitruvian help measure");
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
  const BodyState state =
      BodyState::from_axis_angle(parameters.pose, parameters.betas, parameters.translation_m);
  Points3d offsets;
  std::optional<Figure> figure;
  std::optional<SurfaceMeasurement> surface;
  try {
    offsets = rest_offsets(arguments, registration, body);
    figure.emplace(measured, state, offsets);
    if (!arguments.scan_file.empty()) {
      surface = compare_with_scan(arguments, registration, *figure, context.interrupt);
    }
  } catch (const Error& error) {
    if (error.code() == ErrorCode::usage || error.code() == ErrorCode::cancelled) throw;
    context.error << "vitruvian: " << error.what() << "\n";
    return ExitStatus::unreadable;
  }
  report.body = measure_body(*figure);
  const LandmarkSet landmarks(measured);
  const Figure standing(measured, standard_posture(measured, parameters.betas), offsets);
  report.dimensions = measure_dimensions(standing, *figure, landmarks, fit_errors(registration));
  report.landmarks = landmark_reports(registration, *figure, landmarks, surface ? &*surface : nullptr);
  report.sections = wanted_sections(*figure, arguments);
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
  const MeasuredRegistration everything{
      registration, report, *figure, standing, state, offsets, surface ? &*surface : nullptr};
  for (const std::string& format : arguments.exports) {
    for (const ExportedFile& file : export_files(format, everything))
      write_file(path(file.name.c_str()), file.content);
    context.interrupt.check();
  }
  context.out << "Written  " << printable(arguments.out) << "\n";
  return ExitStatus::ok;
}

}  // namespace vitruvian
