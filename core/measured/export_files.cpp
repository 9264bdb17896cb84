#include "measured/export_files.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "exports/motion_files.h"
#include "exports/skinned_glb.h"
#include "io/mesh_writer.h"
#include "measured/report.h"

namespace vitruvian {
namespace {

/// Red at this distance, millimetres.
constexpr double kWorstColour = 20;
constexpr std::array<std::string_view, 8> kFormats = {"html", "glb",       "npz", "smpl",
                                                      "trc",  "landmarks", "ply", "obj"};

/// Clearly different neighbours: hues a golden angle apart.
std::array<std::uint8_t, 3> segment_colour(int segment) {
  const double hue = std::fmod(segment * 0.61803398875, 1.0) * 6;
  std::array<std::uint8_t, 3> colour{};
  for (int k = 0; k < 3; ++k) {
    const double distance = std::abs(std::fmod(hue - 2 * k + 9, 6.0) - 3);
    colour[static_cast<std::size_t>(k)] =
        static_cast<std::uint8_t>(70 + 170 * std::clamp(2 - distance, 0.0, 1.0));
  }
  return colour;
}

/// Blue over white to red.
std::array<std::uint8_t, 3> error_colour(double mm) {
  const double t = std::clamp(mm / kWorstColour, 0.0, 1.0), low = std::min(1.0, 2 * t),
               high = std::max(0.0, 2 * t - 1);
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(255 * value)); };
  return {byte(0.2 + 0.8 * low), byte(0.35 + 0.6 * low - 0.8 * high), byte(0.8 + 0.15 * low - 0.8 * high)};
}

ExportedBody exported_body(const MeasuredRegistration& m) {
  ExportedBody body{
      m.body(), m.state(), m.registration().model.gender, m.registration().alignment.body_from_scan,
      {},       0,         m.report().body.mass_kg};
  body.stature_m = m.standing().vertices.row(1).maxCoeff() - m.standing().vertices.row(1).minCoeff();
  body.rest_offsets = m.rest_offsets();
  for (const LandmarkReport& landmark : m.report().landmarks)
    body.landmarks.push_back({landmark.name, landmark.body_m});
  return body;
}

/// segments and, with a scan, errors; as PLY with the value beside the colour, or as OBJ.
std::vector<ExportedFile> coloured_meshes(const MeasuredRegistration& m, bool ply) {
  const BodyModel& body = m.body();
  const Mat4d scan_from_body = m.registration().alignment.body_from_scan.inverse();
  const Points3d vertices = (scan_from_body.topLeftCorner<3, 3>() * m.scanned().vertices).colwise() +
                            scan_from_body.topRightCorner<3, 1>();
  std::vector<ExportedFile> files;
  const auto add = [&](const std::string& name, const std::string& value_name, const auto& value,
                       const auto& colour) {
    std::vector<std::uint8_t> colours;
    std::vector<float> values;
    for (int v = 0; v < body.vertex_count(); ++v) {
      values.push_back(static_cast<float>(value(static_cast<std::size_t>(v))));
      for (const std::uint8_t c : colour(values.back())) colours.push_back(c);
    }
    MeshView mesh{vertices, body.faces, colours, values, value_name};
    files.push_back(ply ? ExportedFile{name + ".ply", to_ply(mesh)}
                        : ExportedFile{name + ".obj", to_obj(mesh)});
  };
  add(
      "segments", "segment", [&](std::size_t v) { return body.segment[v]; },
      [](float value) { return segment_colour(static_cast<int>(value)); });
  if (!m.vertex_error_mm().empty()) {
    add(
        "errors", "error_mm", [&](std::size_t v) { return m.vertex_error_mm()[v]; },
        [](float value) { return error_colour(value); });
  }
  return files;
}

}  // namespace

std::span<const std::string_view> export_formats() { return kFormats; }

std::vector<ExportedFile> export_files(std::string_view format, const MeasuredRegistration& m) {
  if (format == "ply" || format == "obj") return coloured_meshes(m, format == "ply");
  if (format == "html") return {{"report.html", measured_report(m)}};
  const ExportedBody body = exported_body(m);
  if (format == "glb") return {{"body.glb", to_skinned_glb(body)}};
  if (format == "npz") return {{"amass.npz", to_amass_npz(body)}};
  if (format == "smpl") return {{"body.smpl", to_smpl_codec(body)}};
  if (format == "trc") {
    return {{"markers.trc", to_trc(body, "markers.trc")}, {"markers_subject.json", to_subject_json(body)}};
  }
  if (format == "landmarks") return {{"landmarks.csv", to_landmark_csv(body)}};
  throw Error(ErrorCode::usage, "--export: there is no format " + std::string(format));
}

}  // namespace vitruvian
