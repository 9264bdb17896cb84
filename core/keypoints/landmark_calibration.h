#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/types.h"
#include "keypoints/view.h"

namespace vitruvian {

/// Where a BlazePose landmark sits on a body model: position = joints[joint] + rotation[frame_joint] *
/// offset, with global (body_from_joint) rotations.
struct LandmarkOffset {
  int landmark;     ///< 0..32
  int joint;        ///< joint the offset starts from
  int frame_joint;  ///< joint whose rotation carries the offset
  Vec3d offset;     ///< metres, rest-pose axes
  double weight;    ///< 0..1.2: how exact this landmark is, relative to 2 cm
};

/// One body of known pose with the landmarks that the views of it gave.
struct CalibrationBody {
  std::vector<Landmark3d> landmarks;  ///< 33, body frame
  Points3d joints;                    ///< 3 x J posed joints, J >= 24, body frame
  std::vector<Mat3d> rotations;       ///< J global rotations
};

/// How well one landmark could be calibrated.
struct CalibrationResidual {
  int landmark;
  double median;        ///< metres, after calibration
  double uncalibrated;  ///< metres, median distance to the bare joint
};

struct Calibration {
  std::vector<LandmarkOffset> offsets;  ///< 23: nose, ears, shoulders, elbows, wrists, pinkies, indices,
                                        ///< hips, knees, ankles, heels, feet
  std::vector<CalibrationResidual> residuals;  ///< in the order of `offsets`
};

/// Learns the offsets as robust means (Cauchy, 3 cm) over the bodies. Of each landmark's candidate frames the
/// one with the smallest median residual is taken, for left and right together; offsets are averaged with
/// their mirror images. Expects a model with SMPL's joint order that is symmetric about x = 0 at rest.
/// @throws Error(internal) when there is no body or a size is wrong.
Calibration calibrate_landmarks(std::span<const CalibrationBody> bodies);

/// Text of models/landmarks.json: {"landmarks": [{"landmark", "joint", "frame_joint", "offset_m",
/// "weight"}]}.
std::string landmarks_to_json(std::span<const LandmarkOffset> offsets);

/// @param file  named in errors.  @throws Error(bad_model) when the text is not such a file or a value is out
/// of range.
std::vector<LandmarkOffset> landmarks_from_json(const std::string& text, const std::string& file);

}  // namespace vitruvian
