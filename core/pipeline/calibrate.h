#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/execution.h"
#include "base/random.h"
#include "keypoints/landmark_calibration.h"
#include "keypoints/network.h"
#include "pipeline/models.h"

namespace vitruvian {

/// Learns where the landmarks sit on a body model in steps, because networks are run by whoever owns the
/// object: while (auto r = calibrator.next_request()) calibrator.accept(run(*r)). Progress: "calibrate".
class LandmarkCalibrator {
 public:
  /// As calibrate_model(). @param body, prior, execution  must outlive the object.
  LandmarkCalibrator(const BodyModel& body, const PosePrior& prior, int bodies, std::uint32_t seed,
                     const Execution& execution);
  ~LandmarkCalibrator();

  /// @return nothing when all bodies have been looked at.  @throws Error(cancelled).
  std::optional<NetworkRequest> next_request();
  void accept(const NetworkReply& reply);
  /// After next_request() returned nothing.
  Calibration result() const { return calibrate_landmarks(seen_); }

 private:
  struct Look;

  const BodyModel& body_;
  const PosePrior& prior_;
  const std::size_t bodies_;
  const Execution& execution_;
  Random random_;
  std::unique_ptr<Look> look_;  // at the body at work
  std::vector<CalibrationBody> seen_;
};

/// Learns where the landmarks sit on a body model by looking at the model itself: random shapes in poses
/// drawn from the pose prior, seen and triangulated exactly like scans.
/// @param prior   of the model's skeleton (prior_for_skeleton()).
/// @param bodies  number of bodies; 20 or more are enough.
/// @return offsets in SMPL's numbering of 24 joints, whatever the model's joints are.
Calibration calibrate_model(const BodyModel& body, const PosePrior& prior, int bodies, std::uint32_t seed,
                            const std::function<NetworkReply(const NetworkRequest&)>& run_network,
                            const Execution& execution);

/// A calibration in SMPL's numbering as offsets from the model's own joints.
std::vector<LandmarkOffset> landmarks_on(const BodyModel& body, std::vector<LandmarkOffset> offsets);

}  // namespace vitruvian
