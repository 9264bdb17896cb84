#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "anthropometry/dimension_specs.h"
#include "anthropometry/landmarks.h"
#include "geometry/plane_section.h"

namespace vitruvian {

/// The body that is measured: re-posed as the standards want, standing or sitting, or as it was scanned.
enum class Posture { standing, scanned, sitting };

/// What a dimension's course shows.
enum class CourseKind {
  tape,    ///< a tape laid on the skin, closed when it ends where it begins
  line,    ///< straight lines between landmarks
  height,  ///< the vertical between two levels
  extent,  ///< between the outermost points of a section or a foot
};

/// A body dimension; ids are unique but for the posture.
struct Dimension {
  std::string id, name, standard, definition;
  std::string side;  ///< "left", "right" or empty
  Posture posture = Posture::standing;
  double value_m = 0;
  std::optional<double> uncertainty_m;  ///< standard uncertainty; none where the fit's error is unknown
  /// Whether it comes from errors measured on strangers' scans (dimension_errors.h), not from a formula.
  bool uncertainty_is_measured = false;
  /// Mean distance between body and scan over the segments that it touches; none where none was observed.
  std::optional<double> fit_error_m;
  CourseKind course_kind = CourseKind::line;
  /// What was measured along, body frame of the figure that it was taken on.
  std::vector<Vec3d> course;
};

/// Mean distance in metres between the registered body and the scan, a segment; none where it was not
/// observed.
using FitErrors = std::array<std::optional<double>, kSegmentCount>;

/// How near the measured body is to its scan.
struct FitQuality {
  FitErrors errors;
  bool refined = false;  ///< whether the body has vertex offsets (`--detail vertex`)
};

/// All dimensions that can be taken on this body.
/// @param standing  the body in standard_posture(); every dimension is taken on it.
/// @param scanned   the same body in the pose of the scan: tapes and lines are laid over the same points of
/// its
///                  skin. Heights, extents and levels have no meaning there and are left out.
std::vector<Dimension> measure_dimensions(const Figure& standing, const Figure& scanned,
                                          const LandmarkSet& landmarks, const FitQuality& fit);

}  // namespace vitruvian
