#include "fit/hypotheses.h"

#include <algorithm>
#include <array>
#include <limits>

#include "fit/extremity_flip.h"
#include "fit/limb_search.h"

namespace vitruvian {
namespace {

bool is_bare(const FitScore& score, const HypothesisSettings& settings) {
  return score.typical < settings.bare_typical;
}

bool has_opposed_parts(const FitScore& score, const HypothesisSettings& settings) {
  return score.opposed_normals >
         (is_bare(score, settings) ? settings.bad_opposed_bare : settings.bad_opposed_clothed);
}

bool lacks_a_small_part(const FitScore& score, const HypothesisSettings& settings) {
  return is_bare(score, settings) && (score.scan_to_model_p99 > settings.bad_bare_scan_to_model_p99 ||
                                      score.model_to_scan_p99 > settings.bad_bare_model_to_scan_p99);
}

bool is_unexplained_at_large(const FitScore& score, const HypothesisSettings& settings) {
  const bool bare = is_bare(score, settings);
  return score.scan_to_model_p95 >
             (bare ? settings.bad_bare_scan_to_model_p95 : settings.bad_scan_to_model_p95) ||
         score.model_to_scan_p95 >
             (bare ? settings.bad_bare_model_to_scan_p95 : settings.bad_model_to_scan_p95);
}

/// Whether a limb search may help: it looks for what lies away from the scan, not for what lies in its place.
bool is_unexplained(const FitScore& score, const HypothesisSettings& settings) {
  return is_unexplained_at_large(score, settings) || lacks_a_small_part(score, settings);
}

bool is_hopeless(const FitScore& score, const HypothesisSettings& settings) {
  return score.scan_to_model_p95 > settings.hopeless_scan_to_model_p95 ||
         score.model_to_scan_p95 > settings.bad_model_to_scan_p95 || has_opposed_parts(score, settings) ||
         (is_bare(score, settings) && is_unexplained(score, settings));
}

/// Misfit of a hand or foot beyond which it may be turned, m.
double extremity_limit(const FitScore& score, const HypothesisSettings& settings) {
  return score.typical * (is_bare(score, settings) ? settings.bad_bare_extremity : settings.bad_extremity);
}

constexpr std::array kShoulders = {11}, kElbows = {13}, kHips = {23}, kKnees = {25};
constexpr std::array kHands = {15, 17, 19}, kFeet = {27, 29, 31};

/// Where the landmarks of a start come from.
enum class Source { swap_aware, plain, fitted };

/// Left landmarks (odd numbers) that a start exchanges with their right partners.
struct Start {
  const char* name;
  Source source;
  bool hands, elbows, shoulders, feet, knees, hips, head;

  bool moves_arms() const { return hands || elbows || shoulders; }
  bool moves_legs() const { return feet || knees || hips; }
};

// The first start is the triangulation as it is; the order of the others is by how often each was the cure.
constexpr Start kStarts[] = {
    {"landmarks", Source::swap_aware, false, false, false, false, false, false, false},
    {"plain triangulation", Source::plain, false, false, false, false, false, false, false},
    {"legs exchanged", Source::swap_aware, false, false, false, true, true, false, false},
    {"arms exchanged", Source::swap_aware, true, true, false, false, false, false, false},
    {"forearms exchanged", Source::swap_aware, true, false, false, false, false, false, false},
    {"fitted forearms exchanged", Source::fitted, true, false, false, false, false, false, false},
    {"fitted shanks exchanged", Source::fitted, false, false, false, true, false, false, false},
    {"left and right exchanged", Source::swap_aware, true, true, true, true, true, true, true},
    {"legs and hips exchanged", Source::swap_aware, false, false, false, true, true, true, false},
    {"arms and shoulders exchanged", Source::swap_aware, true, true, true, false, false, false, false},
    {"shanks exchanged", Source::swap_aware, false, false, false, true, false, false, false},
    {"arms and legs exchanged", Source::swap_aware, true, true, false, true, true, false, false},
};

bool exchanges(const Start& start, int landmark) {
  const int left = std::min(landmark, mirrored_landmark(landmark));
  const auto in = [&](const auto& list) { return std::find(list.begin(), list.end(), left) != list.end(); };
  return (start.hands && in(kHands)) || (start.elbows && in(kElbows)) ||
         (start.shoulders && in(kShoulders)) || (start.feet && in(kFeet)) || (start.knees && in(kKnees)) ||
         (start.hips && in(kHips)) || (start.head && left < 11);
}

std::vector<LandmarkTarget> exchanged(const std::vector<LandmarkTarget>& landmarks, const Start& start) {
  std::vector<LandmarkTarget> result = landmarks;
  for (LandmarkTarget& l : result) {
    if (!exchanges(start, l.landmark)) continue;
    const int partner = mirrored_landmark(l.landmark);
    for (const LandmarkTarget& other : landmarks) {
      if (other.landmark == partner) l.target = other.target, l.weight = other.weight;
    }
  }
  return result;
}

/// The landmarks where a fitted body has them.
std::vector<LandmarkTarget> fitted(const FitModel& model, const BodyState& state,
                                   std::vector<LandmarkTarget> landmarks) {
  const Skeleton skeleton = pose_skeleton(model.body, state);
  for (LandmarkTarget& l : landmarks) {
    l.target = landmark_position(skeleton, l);
    l.weight = std::max(l.weight, 0.5);
  }
  return landmarks;
}

struct Fit {
  BodyState state;
  FitScore score;
};

constexpr int kCoarseScoreSamples = 2000;
constexpr double kAllWrong = 1.3;  // times the best start's FitScore::total()

/// Whether two states pose the joints alike.
bool same_pose(const FitModel& model, const BodyState& a, const BodyState& b, double tolerance) {
  const Points3d joints_a = pose_skeleton(model.body, a).joints,
                 joints_b = pose_skeleton(model.body, b).joints;
  return (joints_a - joints_b).colwise().norm().maxCoeff() < tolerance;
}

/// Refits all candidates, each on one thread, and returns them scored in the candidates' order.
std::vector<Fit> refit(const FitModel& model, const ScanTarget& scan,
                       const std::vector<BodyState>& candidates, const FitSchedule& schedule,
                       const Execution& execution) {
  std::vector<Fit> fits(candidates.size());
  execution.parallel_for(static_cast<std::ptrdiff_t>(candidates.size()), 1,
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           const Execution single(1, &execution);
                           for (std::ptrdiff_t i = begin; i < end; ++i) {
                             fits[i].state = candidates[i];
                             fit_surface(model, scan, schedule, {}, fits[i].state, single);
                             fits[i].score = score_fit(model, scan, fits[i].state, kCoarseScoreSamples);
                           }
                         });
  return fits;
}

/// Limb re-search until it no longer helps. Returns the number of limbs found again.
int repair(const FitModel& model, const ScanTarget& scan, const HypothesisSettings& settings, Fit& fit,
           int& budget, const Execution& execution) {
  int repairs = 0;
  for (int round = 0; round < settings.repair_rounds && is_unexplained(fit.score, settings) && budget > 0;
       ++round) {
    std::array<std::vector<BodyState>, 4> found;
    execution.parallel_for(4, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t limb = begin; limb < end; ++limb) {
        found[limb] =
            search_limb(model, scan, fit.state, static_cast<int>(limb), settings.candidates_per_limb);
      }
    });
    std::vector<BodyState> candidates;
    for (const auto& of_limb : found) candidates.insert(candidates.end(), of_limb.begin(), of_limb.end());
    if (static_cast<int>(candidates.size()) > budget) candidates.resize(budget);
    budget -= static_cast<int>(candidates.size());
    fit.score = score_fit(model, scan, fit.state, kCoarseScoreSamples);
    bool better = false;
    for (Fit& other : refit(model, scan, candidates, FitSchedule::after_limb_search(), execution)) {
      if (other.score.total() < fit.score.total() - settings.least_gain) {
        fit = std::move(other);
        better = true;
      }
    }
    if (!better) break;
    ++repairs;
  }
  return repairs;
}

/// The limits that fit to the scan: fewer for one with holes.
HypothesisSettings settings_for(const ScanTarget& scan, HypothesisSettings settings) {
  if (!scan.at_rim.empty()) {
    // Of a thin part that was scanned from one side alone the other side is near, faces away, and is no
    // fault.
    settings.bad_opposed_bare = settings.bad_opposed_clothed;
    settings.bad_bare_model_to_scan_p95 = settings.bad_model_to_scan_p95;
    settings.bad_bare_model_to_scan_p99 = std::numeric_limits<double>::infinity();
  }
  return settings;
}

/// Finds out whether a fit is still bad, and which hands and feet speak against it.
void judge(const FitModel& model, const ScanTarget& scan, const HypothesisSettings& settings,
           HypothesisResult& result) {
  PosedModel posed;
  posed.update(model, result.state);
  for (int limb = 0; limb < 4; ++limb) {
    const double misfit = extremity_misfit(model, scan, posed, limb);
    result.misfit_limbs[limb] = misfit > extremity_limit(result.score, settings);
    result.limb_misfit[limb] = result.score.typical > 0 ? misfit / result.score.typical : 0;
  }
  result.bad = is_hopeless(result.score, settings);
  result.limb_away = is_unexplained_at_large(result.score, settings);
}

/// Starts that only move what lies well already are left out, unless whole limbs are away from the scan.
bool worth_trying(const Start& start, const HypothesisResult& best) {
  const auto& misfit = best.misfit_limbs;
  const bool arms = misfit[0] || misfit[1], legs = misfit[2] || misfit[3];
  // Whole limbs away from the scan are not brought back by exchanging hands or feet alone.
  const bool ends_only = (start.hands && !start.elbows) || (start.feet && !start.knees);
  if (best.limb_away) return !ends_only;
  if (arms == legs || start.source == Source::plain) return true;
  return arms ? start.moves_arms() : start.moves_legs();
}

/// Hands and feet tried back to front where they fit badly. Returns the number turned.
int turn_extremities(const FitModel& model, const ScanTarget& scan, const HypothesisSettings& settings,
                     Fit& fit, int& budget, const Execution& execution) {
  int turned = 0;
  while (budget > 0 && turned < 4) {
    std::vector<BodyState> candidates =
        turned_extremities(model, scan, fit.state, extremity_limit(fit.score, settings));
    if (static_cast<int>(candidates.size()) > budget) candidates.resize(budget);
    if (candidates.empty()) break;
    budget -= static_cast<int>(candidates.size());
    fit.score = score_fit(model, scan, fit.state, kCoarseScoreSamples);
    const double before = fit.score.total();
    // A hand is a hundredth of the surface, and what shoes gain by turning is chance.
    const double gain = is_bare(fit.score, settings) ? settings.least_turn_gain : settings.least_gain;
    for (Fit& other : refit(model, scan, candidates, FitSchedule::after_limb_search(), execution)) {
      if (other.score.total() < fit.score.total() - gain) fit = std::move(other);
    }
    if (fit.score.total() == before) break;
    ++turned;
  }
  return turned;
}

}  // namespace

int mirrored_landmark(int landmark) {
  constexpr std::array<int, 11> face = {0, 4, 5, 6, 1, 2, 3, 8, 7, 10, 9};
  if (landmark < 11) return face[landmark];
  return landmark % 2 == 1 ? landmark + 1 : landmark - 1;
}

HypothesisResult fit_hypotheses(const FitModel& model, const ScanTarget& scan,
                                const std::vector<LandmarkTarget>& landmarks,
                                const std::vector<LandmarkTarget>& plain, const HypothesisSettings& given,
                                const Execution& execution) {
  const HypothesisSettings settings = settings_for(scan, given);
  HypothesisResult best;
  std::vector<BodyState> tried;
  int budget = settings.refit_budget;
  for (const Start& start : kStarts) {
    const bool first = tried.empty();
    if (start.source == Source::plain && plain.empty()) continue;
    if (!first && (budget <= 0 || !worth_trying(start, best))) continue;
    std::vector<LandmarkTarget> targets = start.source == Source::plain ? plain : landmarks;
    if (start.source == Source::fitted) targets = fitted(model, best.state, std::move(targets));
    targets = exchanged(targets, start);
    Fit fit;
    fit.state = first && settings.landmark_fit ? *settings.landmark_fit : fit_landmarks(model, targets);
    fit_surface(model, scan, FitSchedule::coarse(), targets, fit.state, execution);
    if (!first) --budget;
    // A start that ends where an earlier one did would only repeat its repairs.
    if (std::any_of(tried.begin(), tried.end(),
                    [&](const BodyState& t) { return same_pose(model, t, fit.state, settings.same_pose); })) {
      continue;
    }
    tried.push_back(fit.state);
    fit.score = score_fit(model, scan, fit.state, kCoarseScoreSamples);
    // Next to a body that is right but for a hand, one that lies all wrong is not worth mending.
    if (!first && !best.limb_away && fit.score.total() > kAllWrong * best.score.total()) continue;
    const int repairs = first || best.limb_away ? repair(model, scan, settings, fit, budget, execution) : 0;
    if (repairs > 0) tried.push_back(fit.state);
    const int turned = is_unexplained_at_large(fit.score, settings)
                           ? 0
                           : turn_extremities(model, scan, settings, fit, budget, execution);
    fit_surface(model, scan, FitSchedule::polish(), {}, fit.state, execution);
    fit.score = score_fit(model, scan, fit.state);
    const double gap = fit.score.total() - best.score.total();
    if (first || gap < 0) {
      best.runner_up_gap = first ? 0 : -gap;
      best.state = fit.state;
      best.score = fit.score;
      best.start = start.name;
      best.repairs = repairs;
      best.turned = turned;
      judge(model, scan, settings, best);
    } else {
      best.runner_up_gap = best.runner_up_gap > 0 ? std::min(best.runner_up_gap, gap) : gap;
    }
    if (!best.bad) break;
    if (!best.limb_away) budget = std::min(budget, settings.small_part_budget);
  }
  best.refits = settings.refit_budget - budget;
  return best;
}

HypothesisResult fit_from_state(const FitModel& model, const ScanTarget& scan, const BodyState& start,
                                const std::string& name, const std::vector<LandmarkTarget>& landmarks,
                                const HypothesisSettings& given, const Execution& execution) {
  const HypothesisSettings settings = settings_for(scan, given);
  HypothesisResult result;
  int budget = settings.refit_budget;
  Fit fit{start, {}};
  fit_surface(model, scan, FitSchedule::coarse(), landmarks, fit.state, execution);
  fit.score = score_fit(model, scan, fit.state, kCoarseScoreSamples);
  result.repairs = repair(model, scan, settings, fit, budget, execution);
  fit_surface(model, scan, FitSchedule::polish(), {}, fit.state, execution);
  result.state = fit.state;
  result.score = score_fit(model, scan, fit.state);
  result.start = name;
  judge(model, scan, settings, result);
  result.refits = settings.refit_budget - budget;
  return result;
}

}  // namespace vitruvian
