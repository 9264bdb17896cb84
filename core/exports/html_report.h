#pragma once

#include <string>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// A table row of the report.
struct ReportRow {
  std::string name, value, uncertainty, standard, definition;
};

/// A curve drawn on the body, with the name that is shown beside it.
struct ReportCurve {
  std::string name;
  std::vector<Vec3d> course;  ///< body frame, metres
};

/// What the report shows.
struct ReportContent {
  std::string title, verdict;
  std::vector<std::string> facts;     ///< one line each
  std::vector<ReportRow> dimensions;  ///< standing
  std::vector<ReportRow> segments;
  const Points3d& vertices;  ///< the standing body, body frame
  const Faces& faces;
  std::vector<ReportCurve> curves;  ///< tapes on it
};

/// One HTML page without scripts, fonts or links of its own: pictures from front and left (SVG) with the
/// tapes where they lie, the tables with every definition. Prints to PDF.
std::string to_html_report(const ReportContent& content);

}  // namespace vitruvian
