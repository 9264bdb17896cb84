#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "exports/report_plot.h"

namespace vitruvian {

/// A table row of the report.
struct ReportRow {
  std::string name, value, uncertainty, standard, definition;
};

/// A table with its heading and words below that.
struct ReportTable {
  std::string heading, words;
  std::vector<ReportRow> rows;
};

/// A curve drawn on a body, with the name that is shown when it is pointed at.
struct ReportCurve {
  std::string name;
  std::vector<Vec3d> course;  ///< body frame, metres
};

/// A body that is drawn from the front and from its left.
struct ReportFigure {
  std::string name;
  const Points3d& vertices;  ///< body frame
  std::vector<ReportCurve> curves;
};

/// What the report shows.
struct ReportContent {
  std::string title, verdict;
  std::vector<std::string> facts;  ///< one line each
  std::vector<ReportFigure> figures;
  const Faces& faces;  ///< of all figures
  std::vector<ReportTable> tables;
  std::vector<Plot> profiles;
  std::vector<std::string> remarks;  ///< a paragraph each, at the end
};

/// One HTML page without scripts, fonts or links of its own: the bodies as pictures (SVG) with the tapes
/// where they lie, the profiles as plots, the tables with every definition. Prints to PDF.
std::string to_html_report(const ReportContent& content);

}  // namespace vitruvian
