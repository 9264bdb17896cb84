#pragma once

#include <optional>
#include <string_view>

#include "anthropometry/dimensions.h"

namespace vitruvian {

/// Mean distance in metres between body and scan over some segments; none where none of them was observed.
std::optional<double> mean_fit_error(SegmentSet segments, const FitErrors& errors);

/// Standard uncertainty in metres that was measured: the root mean square error that this dimension had on
/// strangers' scans (dimension_errors.h), made larger in proportion where this scan is fitted worse than
/// those were. None for dimensions that were not compared, and where the fit's error is unknown.
/// @param id       without the side.
/// @param refined  whether the body has vertex offsets.
std::optional<double> known_uncertainty(std::string_view id, bool refined, std::optional<double> fit_error_m);

/// Standard uncertainty in metres estimated from the distance between body and scan where it is measured. A
/// girth sums the error of some four independent patches round the limb (pi e); anything else has two ends,
/// each with its own error and slide along the skin.
/// @param closed  of tapes: whether they go all round.
std::optional<double> estimated_uncertainty(CourseKind kind, bool closed, std::optional<double> fit_error_m);

/// Sets the dimension's uncertainty, and from where it is: known if it can be, else estimated.
/// @param id  without the side.
void set_uncertainty(Dimension& dimension, std::string_view id, bool closed, bool refined);

}  // namespace vitruvian
