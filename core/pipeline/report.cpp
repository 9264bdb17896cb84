#include "pipeline/report.h"

#include <cstdio>
#include <span>

#include "io/npz.h"
#include "measure/verdict_features.h"

namespace vitruvian {
namespace {

template <typename... Values>
std::string text(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::string pooled_line(const char* title, const DistanceStatistics& s) {
  return text("  %-34s %7.2f %7.2f %7.2f %7.2f\n", title, s.mean_mm, s.median_mm, s.p95_mm, s.max_mm);
}

std::string error_table(const SurfaceError& error, const std::optional<SurfaceError>& parametric) {
  std::string out = "Error (mm)                              mean  median     p95     max\n";
  out += pooled_line("model to the scan's surface", error.surface_all);
  if (parametric) out += pooled_line("  before vertex offsets", parametric->surface_all);
  out += pooled_line("model to matched scan points", error.all);
  out += pooled_line("scan to the model's surface", error.scan_to_model);
  out += "By segment, to the scan's surface   seen    mean  median     p95     max\n";
  for (const SegmentError& row : error.surface_segments) {
    out += text("  %-32s %4.0f%%", plain_name(row.segment).c_str(), 100 * row.observed);
    if (row.statistics) {
      const DistanceStatistics& s = *row.statistics;
      out += text(" %7.2f %7.2f %7.2f %7.2f\n", s.mean_mm, s.median_mm, s.p95_mm, s.max_mm);
    } else {
      out += "  not seen\n";
    }
  }
  return out;
}

}  // namespace

std::string errors_csv(const SurfaceError& error) {
  std::string out = "segment,observed,count,mean_mm,std_mm,median_mm,p95_mm,max_mm\n";
  for (const SegmentError& row : error.surface_segments) {
    out += row.segment + text(",%.4f", row.observed);
    if (row.statistics) {
      const DistanceStatistics& s = *row.statistics;
      out += text(",%d,%.4f,%.4f,%.4f,%.4f,%.4f\n", s.count, s.mean_mm, s.std_mm, s.median_mm, s.p95_mm,
                  s.max_mm);
    } else {
      out += ",NA,NA,NA,NA,NA,NA\n";
    }
  }
  return out;
}

std::string offsets_npz(const Points3f& offsets) {
  const NpzItem item{.name = "offsets",
                     .shape = {static_cast<std::size_t>(offsets.cols()), 3},
                     .floats = std::span(offsets.data(), static_cast<std::size_t>(offsets.size()))};
  return to_npz(std::span(&item, 1));
}

std::string report_text(const Registration& r) {
  std::string out =
      "Scan     " + r.scan.file + text(", %ld vertices, %ld faces", r.scan.vertices, r.scan.faces);
  if (!r.alignment.method.empty()) {
    out +=
        ", unit " + to_string(r.alignment.unit) + ", up " + r.alignment.up + ", front " + r.alignment.front;
  }
  out += "\nModel    " + r.model.name + ", " + std::string(name_of(r.model.gender)) +
         text(", %d vertices, %d betas\n", r.model.vertices, r.model.betas);
  out += "Verdict  " + to_string(r.verdict.status) + text(", confidence %.2f\n", r.verdict.confidence);
  for (const std::string& reason : r.verdict.reasons) out += "         - " + reason + "\n";
  if (r.surface_error) out += error_table(*r.surface_error, r.parametric_error);
  const Timing& t = r.timing_ms;
  out += text(
      "Time (s) %.2f: read %.2f, align %.2f, project %.2f, detect %.2f, pose %.2f, fit %.2f, refine %.2f, "
      "detail %.2f, write %.2f\n",
      t.total / 1e3, t.read / 1e3, t.align / 1e3, t.project / 1e3, t.detect / 1e3, t.pose / 1e3, t.fit / 1e3,
      t.refine / 1e3, t.detail / 1e3, t.write / 1e3);
  return out;
}

}  // namespace vitruvian
