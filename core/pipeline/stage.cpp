#include "pipeline/stage.h"

#include "pipeline/placement.h"

namespace vitruvian {
namespace {

constexpr double Timing::*kEntries[] = {&Timing::read, &Timing::align, &Timing::project, &Timing::detect,
                                        &Timing::pose, &Timing::fit,   &Timing::refine,  &Timing::detail};

}  // namespace

std::optional<PipelineStage> first_affected(const Settings& before, const Settings& after) {
  if (before == after) return std::nullopt;
  // Settings that only late stages know are taken over one stage after the other; what then still differs
  // lies before it. A setting that is named nowhere here counts for all stages.
  Settings taken = before;
  taken.detail = after.detail;
  taken.solver = after.solver;
  taken.iterations = after.iterations;
  taken.adam_iterations = after.adam_iterations;
  taken.one_directional = after.one_directional;
  taken.chunk = after.chunk;
  taken.regions = after.regions;
  if (taken == after) return PipelineStage::fit;
  taken.gender = after.gender;
  taken.betas = after.betas;
  // A start that was given makes looking for landmarks superfluous.
  if (looks_for_landmarks(before) == looks_for_landmarks(after)) {
    taken.init = after.init;
    taken.start = after.start;
  }
  if (taken == after) return PipelineStage::pose;
  taken.init = after.init;
  taken.start = after.start;
  if (!lies_by_keypoints(before) && !lies_by_keypoints(after)) taken.keypoints = after.keypoints;
  taken.views = after.views;
  taken.min_visibility = after.min_visibility;
  if (taken == after) return PipelineStage::keypoints;
  return PipelineStage::align;
}

void StageClock::work_for(std::optional<PipelineStage> stage) {
  const std::size_t owner = stage ? 1 + static_cast<std::size_t>(*stage) : 0;
  if (owner == owner_) return;
  double Timing::*entry = entry_;
  pause();
  owner_ = owner;
  enter(entry);
}

void StageClock::enter(double Timing::*entry) {
  const Clock::time_point now = Clock::now();
  if (entry_) times_[owner_].*entry_ += std::chrono::duration<double, std::milli>(now - since_).count();
  entry_ = entry;
  since_ = now;
}

void StageClock::pause() { enter(nullptr); }

void StageClock::forget(PipelineStage stage) {
  pause();
  for (std::size_t i = 1 + static_cast<std::size_t>(stage); i < times_.size(); ++i) times_[i] = Timing();
}

Timing StageClock::sum() const {
  Timing sum;
  for (double Timing::*entry : kEntries) {
    for (const Timing& times : times_) sum.*entry += times.*entry;
    sum.total += sum.*entry;
  }
  return sum;
}

}  // namespace vitruvian
