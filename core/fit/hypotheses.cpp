#include "fit/hypotheses.h"

#include <algorithm>
#include <array>

#include "fit/limb_search.h"

namespace vitruvian {
namespace {

bool is_bad(const FitScore& score, const HypothesisSettings& settings) {
  return score.scan_to_model_p95 > settings.bad_scan_to_model_p95 ||
         score.model_to_scan_p95 > settings.bad_model_to_scan_p95;
}

bool is_hopeless(const FitScore& score, const HypothesisSettings& settings) {
  return score.scan_to_model_p95 > settings.hopeless_scan_to_model_p95 ||
         score.model_to_scan_p95 > settings.bad_model_to_scan_p95;
}

constexpr std::array kShoulders = {11}, kHips = {23};
constexpr std::array kArms = {13, 15, 17, 19}, kLegs = {25, 27, 29, 31};

/// Left landmarks (odd numbers) that a start exchanges with their right partners.
struct Start {
  const char* name;
  bool plain;
  bool arms, shoulders, legs, hips, head;
};

// The first start is the triangulation as it is; the order of the others is by how often each was the cure.
constexpr Start kStarts[] = {
    {"landmarks", false, false, false, false, false, false},
    {"plain triangulation", true, false, false, false, false, false},
    {"legs exchanged", false, false, false, true, false, false},
    {"arms exchanged", false, true, false, false, false, false},
    {"left and right exchanged", false, true, true, true, true, true},
    {"legs and hips exchanged", false, false, false, true, true, false},
    {"arms and shoulders exchanged", false, true, true, false, false, false},
    {"arms and legs exchanged", false, true, false, true, false, false},
};

bool exchanges(const Start& start, int landmark) {
  const int left = std::min(landmark, mirrored_landmark(landmark));
  const auto in = [&](const auto& list) { return std::find(list.begin(), list.end(), left) != list.end(); };
  return (start.arms && in(kArms)) || (start.shoulders && in(kShoulders)) || (start.legs && in(kLegs)) ||
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

struct Fit {
  BodyState state;
  FitScore score;
};

constexpr int kCoarseScoreSamples = 2000;

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
  for (int round = 0; round < settings.repair_rounds && is_bad(fit.score, settings) && budget > 0; ++round) {
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

}  // namespace

int mirrored_landmark(int landmark) {
  constexpr std::array<int, 11> face = {0, 4, 5, 6, 1, 2, 3, 8, 7, 10, 9};
  if (landmark < 11) return face[landmark];
  return landmark % 2 == 1 ? landmark + 1 : landmark - 1;
}

HypothesisResult fit_hypotheses(const FitModel& model, const ScanTarget& scan,
                                const std::vector<LandmarkTarget>& landmarks,
                                const std::vector<LandmarkTarget>& plain, const HypothesisSettings& settings,
                                const Execution& execution) {
  HypothesisResult best;
  std::vector<BodyState> tried;
  int budget = settings.refit_budget;
  for (const Start& start : kStarts) {
    const bool first = tried.empty();
    if (start.plain && plain.empty()) continue;
    if (!first && budget <= 0) break;
    const std::vector<LandmarkTarget> targets = start.plain ? plain : exchanged(landmarks, start);
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
    const int repairs = repair(model, scan, settings, fit, budget, execution);
    if (repairs > 0) tried.push_back(fit.state);
    fit_surface(model, scan, FitSchedule::polish(), {}, fit.state, execution);
    fit.score = score_fit(model, scan, fit.state);
    const double gap = fit.score.total() - best.score.total();
    if (first || gap < 0) {
      best.runner_up_gap = first ? 0 : -gap;
      best.state = fit.state;
      best.score = fit.score;
      best.start = start.name;
      best.repairs = repairs;
      best.bad = is_hopeless(fit.score, settings);
    } else {
      best.runner_up_gap = best.runner_up_gap > 0 ? std::min(best.runner_up_gap, gap) : gap;
    }
    if (!best.bad) break;
  }
  best.refits = settings.refit_budget - budget;
  return best;
}

HypothesisResult fit_from_state(const FitModel& model, const ScanTarget& scan, const BodyState& start,
                                const std::string& name, const std::vector<LandmarkTarget>& landmarks,
                                const HypothesisSettings& settings, const Execution& execution) {
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
  result.bad = is_hopeless(result.score, settings);
  result.refits = settings.refit_budget - budget;
  return result;
}

}  // namespace vitruvian
