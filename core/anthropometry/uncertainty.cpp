#include "anthropometry/uncertainty.h"

#include <cmath>
#include <numbers>

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

std::optional<double> estimated_uncertainty(CourseKind kind, bool closed, std::optional<double> fit_error_m) {
  if (!fit_error_m) return std::nullopt;
  if (kind != CourseKind::tape) return std::numbers::sqrt2 * std::hypot(*fit_error_m, kLandmarkSlide);
  return std::hypot((closed ? std::numbers::pi : std::numbers::sqrt2) * *fit_error_m, kLandmarkSlide);
}

}  // namespace vitruvian
