#pragma once

#include <functional>

#include "align/units.h"
#include "fit/hypotheses.h"
#include "fit/refine.h"
#include "pipeline/landmark_stage.h"
#include "pipeline/models.h"
#include "pipeline/prepared_scan.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// A fitted scan, ready for its last stages.
struct OutcomeInput {
  const Models& models;
  const FitModel& fit_model;
  const Settings& settings;
  const PreparedScan& scan;
  const Mat4d& body_from_scan;
  const HypothesisResult& fit;
  const std::vector<LandmarkTarget>& targets;  ///< what the fit was to meet, body frame
  const std::vector<Keypoint>& keypoints;      ///< 22, body frame
  const RegionLabels& regions;                 ///< of the scan's vertices
  UnitCandidate unit{};
  std::string unit_note{};
  std::string method{};
  double stature = 0;
  bool refine = true;  ///< false: the fit is final, as published
  /// Called when the work turns to another stage, for its time.
  std::function<void(double Timing::*)> begin_stage = [](double Timing::*) {};
};

/// Refines the fit on the whole scan, measures it, judges it, adds vertex offsets when they are wanted, and
/// puts the result together in the scan's frame. The verdict is about the parametric body: offsets would
/// cover up what it is judged from.
Registration make_outcome(const OutcomeInput& input, const Execution& execution);

/// The transform in the words of the report.
/// @param method  how it was found.
Alignment describe_alignment(const Mat4d& body_from_scan, const UnitCandidate& unit,
                             const std::string& method);

/// Height of the body with these betas in its rest pose, m.
double standing_stature(const BodyModel& body, const Eigen::VectorXd& betas);

/// Unit by its short name ("m", "cm", "mm", "in").
Unit unit_named(const std::string& name);

}  // namespace vitruvian
