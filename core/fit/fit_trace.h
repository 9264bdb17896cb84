#pragma once

#include <vector>

#include "fit/fit_model.h"
#include "fit/fit_observer.h"

namespace vitruvian {

/// What one iteration minimises, term by term, weighted as in its step. The surface's terms count distances
/// in units of the robust scale, which falls: they can be compared with each other, not over iterations.
struct FitEnergy {
  double model_to_scan = 0;
  double scan_to_model = 0;
  double landmarks = 0;
  double pose_prior = 0;
  double joint_limits = 0;
  double shape_prior = 0;
};

/// One iteration, before its step; the last step of a trace is the fitted body.
struct TraceStep {
  int stage = 0;     ///< FitIteration::stage
  double scale = 0;  ///< m
  FitEnergy energy;
  double model_to_scan_m = 0;  ///< median distance of the samples along the scan's normal
  double scan_to_model_m = 0;
  double landmark_m = 0;    ///< weighted mean
  Eigen::Matrix3Xf joints;  ///< 3 x J, body frame
  BodyState state;
  /// Pairs that count, evenly picked: template vertex and scan point, body frame. The first pairs_of_model
  /// were found from the model's side, the others from the scan's.
  Eigen::Matrix<float, 6, Eigen::Dynamic> pairs;
  int pairs_of_model = 0;
};

/// Records a fit for looking at it. Memory is bounded: at most `most_steps` iterations (later ones replace
/// the last) with at most `most_pairs` pairs each.
class FitTrace {
 public:
  explicit FitTrace(const FitModel& model, int most_steps = 300, int most_pairs = 200)
      : model_(model), most_steps_(most_steps), most_pairs_(most_pairs) {}

  /// To be handed to a fit; the trace must outlive it.
  FitObserver observer();
  /// Adds the body that the fit ended with.
  void finish(const BodyState& state);

  const std::vector<TraceStep>& steps() const { return steps_; }

 private:
  void add(TraceStep step);

  const FitModel& model_;
  int most_steps_, most_pairs_;
  std::vector<TraceStep> steps_;
};

/// Terms of an iteration's objective.
FitEnergy energy_of(const FitModel& model, const FitIteration& iteration);

}  // namespace vitruvian
