#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "base/types.h"
#include "keypoints/network.h"
#include "keypoints/views.h"

namespace vitruvian {

/// A direction that may be the body's up (hips to head), with what speaks for it.
struct UpHypothesis {
  Vec3d up;      ///< unit, axes of the surface
  double score;  ///< 0..1; share of the evidence that agrees, times how sure the detector was
  int views;     ///< pictures in which the detector saw the body upright along it
  bool is_axis;  ///< it was taken as exactly a file axis, since that explains the pictures as well
};

/// Finds which way is up in a scan of any orientation and posture: the pose detector looks at the scan from
/// several sides and tells how far the body is turned in each picture; the direction in space that explains
/// the pictures best wins. Three looks along the file's axes and two to confirm suffice for ordinary files;
/// ten more follow otherwise.
///
///   UpDetector detector(surface, execution);
///   while (auto request = detector.next_request()) detector.accept(run(*request));
///   const std::vector<UpHypothesis> ups = detector.result();
class UpDetector {
 public:
  /// @param surface    metres or any unit; must outlive the detector. About 10,000 triangles are plenty.
  /// @param execution  must outlive the detector.
  UpDetector(const ViewSurface& surface, const Execution& execution);

  /// The runs needed next, or nothing when the result is complete. The same request until accept() is called.
  std::optional<NetworkRequest> next_request() const;
  /// Takes the answer to the current request. @throws Error(internal) when nothing is asked or the reply does
  /// not fit.
  void accept(const NetworkReply& reply);

  /// Distinct directions (30 degrees apart or more), best first; at least one. When no picture showed a body,
  /// the file axis of the longest extent among y and z with score 0. @throws Error(internal) before the last
  /// reply.
  std::vector<UpHypothesis> result() const;

  /// Pictures taken so far; for tests and reports.
  int looks() const { return static_cast<int>(observations_.size()); }

 private:
  /// What one picture says.
  struct Observation {
    Vec3d toward_viewer;
    Vec3d up_in_picture;  ///< unit, perpendicular to toward_viewer; zero when no body was seen
    double score;         ///< of the detection; 0 when no body was seen
  };
  enum class Stage { axes, confirm_axes, sphere, confirm, done };

  void look(const std::vector<std::pair<Vec3d, Vec3d>>& directions_and_ups);
  void confirm(int hypotheses);
  void advance();
  double agreement(const Vec3d& up) const;
  Vec3d refined(Vec3d up) const;
  std::vector<UpHypothesis> ranked() const;

  const ViewSurface& surface_;
  const Execution& execution_;
  Stage stage_ = Stage::axes;
  std::vector<View> views_;  ///< of the current request
  NetworkRequest request_;
  std::vector<Observation> observations_;
};

}  // namespace vitruvian
