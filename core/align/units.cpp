#include "align/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace vitruvian {
namespace {

struct NamedUnit {
  const char* name;
  const char* plural;
  double metres;
};
constexpr std::array<NamedUnit, 4> kUnits{{{"m", "metres", 1.0},
                                           {"cm", "centimetres", 0.01},
                                           {"mm", "millimetres", 0.001},
                                           {"in", "inches", 0.0254}}};

/// Diameters of bodies, metres: outside [kNever, kNeverMore] none, inside [kUsual, kUsualMost] the ordinary
/// ones.
constexpr double kNever = 0.45, kUsual = 1.35, kUsualMost = 2.35, kNeverMore = 3.0;

double likelihood_of(double extent_m) {
  if (extent_m <= kNever || extent_m >= kNeverMore) return 0;
  if (extent_m < kUsual) return std::pow((extent_m - kNever) / (kUsual - kNever), 1.5);
  if (extent_m > kUsualMost) return (kNeverMore - extent_m) / (kNeverMore - kUsualMost);
  return 1;
}

const char* plural(const std::string& unit) {
  for (const NamedUnit& known : kUnits) {
    if (unit == known.name) return known.plural;
  }
  return "units";
}

std::string metres_text(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", metres);
  return text;
}

}  // namespace

UnitGuess guess_unit(double extent, std::optional<double> declared_metres_per_unit) {
  if (!(extent > 0) || !std::isfinite(extent)) {
    throw Error(ErrorCode::no_geometry, "the scan has no extent: all its points coincide or none is finite");
  }
  UnitGuess guess;
  for (const NamedUnit& unit : kUnits) {
    const double extent_m = extent * unit.metres;
    guess.candidates.push_back({unit.name, unit.metres, extent_m, likelihood_of(extent_m)});
  }
  if (declared_metres_per_unit && likelihood_of(extent * *declared_metres_per_unit) > 0) {
    for (UnitCandidate& candidate : guess.candidates) {
      if (std::fabs(candidate.metres_per_unit / *declared_metres_per_unit - 1) > 1e-6) continue;
      guess.candidates = {UnitCandidate(candidate)};
      return guess;
    }
  }
  std::stable_sort(
      guess.candidates.begin(), guess.candidates.end(),
      [](const UnitCandidate& a, const UnitCandidate& b) { return a.likelihood > b.likelihood; });
  if (guess.candidates.front().likelihood <= 0) {
    // No reading gives a body: the one nearest to an ordinary size, by ratio, is the least wrong.
    constexpr double kOrdinary = 1.7;
    const auto oddness = [](const UnitCandidate& c) { return std::fabs(std::log(c.extent_m / kOrdinary)); };
    std::stable_sort(guess.candidates.begin(), guess.candidates.end(),
                     [&](const UnitCandidate& a, const UnitCandidate& b) { return oddness(a) < oddness(b); });
    guess.candidates.resize(1);
    guess.ambiguous = true;
    guess.note = "no unit makes this scan the size of a person; taken as " +
                 std::string(plural(guess.candidates[0].unit)) + " it measures " +
                 metres_text(guess.candidates[0].extent_m) + " across; state the unit if that is wrong";
    return guess;
  }
  const auto impossible = std::find_if(guess.candidates.begin(), guess.candidates.end(),
                                       [](const UnitCandidate& c) { return c.likelihood <= 0; });
  guess.candidates.erase(impossible, guess.candidates.end());
  if (guess.candidates.size() > 1) {
    const UnitCandidate &first = guess.candidates[0], &second = guess.candidates[1];
    guess.ambiguous = true;
    guess.note = "the scan measures " + metres_text(first.extent_m) + " across in " + plural(first.unit) +
                 " and " + metres_text(second.extent_m) + " in " + plural(second.unit) +
                 "; state the unit if the choice is wrong";
  }
  return guess;
}

}  // namespace vitruvian
