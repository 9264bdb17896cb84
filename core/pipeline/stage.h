#pragma once

#include <array>
#include <chrono>
#include <optional>

#include "pipeline/registration.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// Stages that can be run by themselves and run again, in their order. Each needs the ones before it.
enum class PipelineStage {
  align,      ///< unit, up and front
  keypoints,  ///< pictures, landmarks in them and in space
  pose,       ///< the body posed by the landmarks alone
  fit,        ///< the registered body
};
constexpr int kPipelineStageCount = 4;

/// First stage whose result a change of settings can alter; nothing when they are the same.
std::optional<PipelineStage> first_affected(const Settings& before, const Settings& after);

/// Adds up the time of each stage of the report, apart for each stage that can be run again, so that one
/// which is run again replaces its earlier time.
class StageClock {
 public:
  /// What is measured from now on belongs to `stage`, or, with nothing, to the scan itself.
  void work_for(std::optional<PipelineStage> stage);
  /// What is measured from now on is `entry`.
  void enter(double Timing::*entry);
  void pause();
  /// Forgets the time of `stage` and all later ones.
  void forget(PipelineStage stage);
  /// Sum over all; `total` included.
  Timing sum() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::array<Timing, kPipelineStageCount + 1> times_{};  // first: of the scan
  std::size_t owner_ = 0;
  double Timing::*entry_ = nullptr;
  Clock::time_point since_;
};

}  // namespace vitruvian
