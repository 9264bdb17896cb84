#include "measured_report.h"

namespace vitruvian::wasm {
namespace {

constexpr const char* kKindNames[] = {"tape", "line", "height", "extent"};

nlohmann::json describe_course(const std::vector<Vec3d>& course) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Vec3d& corner : course) rows.push_back({corner.x(), corner.y(), corner.z()});
  return rows;
}

}  // namespace

nlohmann::json describe_measurements(const MeasuredRegistration& measured) {
  const MeasurementReport& report = measured.report();
  nlohmann::json document = nlohmann::json::parse(measurements_json(report, JsonStyle::compact));
  for (std::size_t i = 0; i < report.dimensions.size(); ++i) {
    const Dimension& dimension = report.dimensions[i];
    nlohmann::json& row = document["dimensions"][i];
    row["kind"] = kKindNames[static_cast<int>(dimension.course_kind)];
    row["course"] = describe_course(measured.course_in_scan(dimension));
  }
  return document;
}

nlohmann::json describe_profile(const MeasuredRegistration& measured, const std::string& segment, int count) {
  const int index = segment_named(segment);
  if (index < 0) throw Error(ErrorCode::usage, "there is no segment " + segment);
  MeasurementReport sections;
  const std::vector<ProfileSection> profile = measured.profile(index, count);
  for (const ProfileSection& section : profile) sections.sections.push_back(section.result);
  nlohmann::json rows = nlohmann::json::parse(measurements_json(sections, JsonStyle::compact)).at("sections");
  for (std::size_t i = 0; i < profile.size(); ++i) rows[i]["course"] = describe_course(profile[i].course);
  return rows;
}

std::vector<ExportedFile> measured_files(const MeasuredRegistration& measured, const std::string& format) {
  std::vector<ExportedFile> files;
  const bool all = format == "all";
  if (all || format == "measurements") {
    files.push_back({"measurements.json", measurements_json(measured.report(), JsonStyle::pretty)});
    files.push_back({"measurements.csv", measurements_csv(measured.report())});
    if (!all) return files;
  }
  for (const std::string_view each : export_formats()) {
    if (!all && each != format) continue;
    for (ExportedFile& file : export_files(each, measured)) files.push_back(std::move(file));
  }
  if (files.empty()) throw Error(ErrorCode::usage, "there is no format " + format);
  return files;
}

}  // namespace vitruvian::wasm
