#include "anthropometry/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "anthropometry/dimension_errors.h"

namespace vitruvian {
namespace {

/// Landmarks are points of the template: how far they slide along the skin from one scan to the next of a
/// person, one standard deviation.
constexpr double kLandmarkSlide = 0.003;

}  // namespace

std::optional<double> mean_fit_error(SegmentSet segments, const FitErrors& errors) {
  double sum = 0;
  int count = 0;
  for (int s = 0; s < kSegmentCount; ++s) {
    const std::optional<double>& error = errors[static_cast<std::size_t>(s)];
    if (!(segments >> s & 1) || !error) continue;
    sum += *error;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::optional<double> known_uncertainty(std::string_view id, bool refined,
                                        std::optional<double> fit_error_m) {
  if (!fit_error_m) return std::nullopt;
  for (const DimensionError& known : dimension_errors()) {
    if (known.id != id) continue;
    const DimensionError::Size& size = refined ? known.refined : known.parametric;
    const double worse = size.fit_mm > 0 ? 1e3 * *fit_error_m / size.fit_mm : 1;
    return 1e-3 * size.rms_mm * std::max(1.0, worse);
  }
  return std::nullopt;
}

std::optional<double> estimated_uncertainty(CourseKind kind, bool closed, std::optional<double> fit_error_m) {
  if (!fit_error_m) return std::nullopt;
  if (kind != CourseKind::tape) return std::numbers::sqrt2 * std::hypot(*fit_error_m, kLandmarkSlide);
  return std::hypot((closed ? std::numbers::pi : std::numbers::sqrt2) * *fit_error_m, kLandmarkSlide);
}

void set_uncertainty(Dimension& dimension, std::string_view id, bool closed, bool refined) {
  dimension.uncertainty_m = known_uncertainty(id, refined, dimension.fit_error_m);
  dimension.uncertainty_is_measured = dimension.uncertainty_m.has_value();
  if (!dimension.uncertainty_m) {
    dimension.uncertainty_m = estimated_uncertainty(dimension.course_kind, closed, dimension.fit_error_m);
  }
}

}  // namespace vitruvian
