#pragma once

#include <optional>

#include "anthropometry/dimensions.h"

namespace vitruvian {

/// Mean distance in metres between body and scan over some segments; none where none of them was observed.
std::optional<double> mean_fit_error(SegmentSet segments, const FitErrors& errors);

/// Standard uncertainty in metres estimated from the distance between body and scan where it is measured. A
/// girth sums the error of some four independent patches round the limb (pi e); anything else has two ends,
/// each with its own error and slide along the skin.
/// @param closed  of tapes: whether they go all round.
std::optional<double> estimated_uncertainty(CourseKind kind, bool closed, std::optional<double> fit_error_m);

}  // namespace vitruvian
