#include "measured/report.h"

#include <array>
#include <cmath>
#include <limits>

#include "exports/html_report.h"
#include "exports/markup.h"

namespace vitruvian {
namespace {

/// Segments whose profiles are plotted: one limb of each kind, and the trunk.
constexpr std::array<std::string_view, 6> kProfiled = {"left_arm", "left_forearm", "left_upper_leg",
                                                       "left_leg", "spine",        "spine2"};
constexpr int kProfileSections = 41;

std::string spaced(std::string_view name) {
  std::string out(name);
  for (char& c : out) {
    if (c == '_') c = ' ';
  }
  return out;
}

/// Girth, breadth and depth against the way from the proximal joint, millimetres.
Plot profile_plot(const MeasuredRegistration& m, std::string_view segment) {
  const int index = segment_named(segment);
  const double length_mm = 1e3 * m.scanned().axes[static_cast<std::size_t>(index)].length();
  Plot plot{
      spaced(segment), "mm from proximal joint", "mm", {}, {{"girth", {}}, {"breadth", {}}, {"depth", {}}}};
  for (const SectionResult& section : section_profile(m.scanned(), index, kProfileSections)) {
    plot.x.push_back(section.t * length_mm);
    const std::array<double SectionMeasure::*, 3> shown = {&SectionMeasure::hull_perimeter,
                                                           &SectionMeasure::breadth, &SectionMeasure::depth};
    for (std::size_t i = 0; i < shown.size(); ++i) {
      plot.lines[i].y.push_back(section.measured ? 1e3 * ((*section.measured).*shown[i])
                                                 : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return plot;
}

ReportRow dimension_row(const Dimension& d) {
  const std::string uncertainty = d.uncertainty_m ? fixed_text(1e3 * *d.uncertainty_m, 1) : "";
  return {d.name + (d.side.empty() ? "" : ", " + d.side), fixed_text(1e3 * d.value_m, 1),
          uncertainty.empty() || d.uncertainty_is_measured ? uncertainty : uncertainty + " (est.)",
          d.standard, d.definition};
}

ReportRow segment_row(const SegmentMeasure& segment, std::string_view name) {
  return {spaced(name), fixed_text(1e6 * segment.volume_m3, 0) + " cm³", "", "",
          "length " + fixed_text(1e3 * segment.length_m, 0) + " mm, surface " +
              fixed_text(1e4 * segment.area_m2, 0) + " cm², mass " + fixed_text(segment.mass_kg, 3) + " kg"};
}

}  // namespace

std::string measured_report(const MeasuredRegistration& m) {
  const BodyMeasures& body = m.report().body;
  const Verdict& verdict = m.registration().verdict;
  ReportContent content{
      "Measurements of " + m.registration().scan.file,
      "Verdict: " + to_string(verdict.status) + ", confidence " + fixed_text(verdict.confidence, 2),
      verdict.reasons,
      {{"standing", m.standing().vertices, {}}, {"sitting", m.seated().vertices, {}}},
      m.body().faces,
      {},
      {},
      {}};
  content.facts.push_back("body volume " + fixed_text(1e3 * body.volume_m3, 2) + " l, surface " +
                          fixed_text(body.area_m2, 3) + " m², mass with published segment densities " +
                          fixed_text(body.mass_kg, 1) + " kg");
  ReportTable standing{"Dimensions standing, millimetres",
                       "Re-posed upright, ankles 200 mm apart, arms 20 degrees from the vertical.",
                       {}};
  ReportTable sitting{
      "Dimensions sitting, millimetres",
      "Re-posed with thighs and forearms level, lower legs vertical; no chair presses the flesh.",
      {}};
  for (const Dimension& d : m.report().dimensions) {
    if (d.posture == Posture::scanned) continue;
    const bool sits = d.posture == Posture::sitting;
    (sits ? sitting : standing).rows.push_back(dimension_row(d));
    const bool on_skin = d.course_kind == CourseKind::tape || d.course_kind == CourseKind::line;
    if (sits || on_skin) content.figures[sits ? 1 : 0].curves.push_back({d.name, d.course});
  }
  ReportTable segments{"Segments", "Volume of the segment's skin closed by caps, as scanned.", {}};
  for (std::size_t s = 0; s < kSegmentCount; ++s)
    segments.rows.push_back(segment_row(body.segments[s], kSegmentNames[s]));
  content.tables = {std::move(standing), std::move(sitting), std::move(segments)};
  for (const std::string_view segment : kProfiled) content.profiles.push_back(profile_plot(m, segment));
  content.remarks = {
      "± is the standard uncertainty: the root mean square error that the dimension had on synthetic scans "
      "of people "
      "outside of the body model, larger where this scan is fitted worse; \"est.\": from a formula. It holds "
      "no "
      "clothes, breathing or soft tissue. Girths are taut tapes round the section. Not a medical device."};
  return to_html_report(content);
}

}  // namespace vitruvian
