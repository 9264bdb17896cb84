#pragma once

#include <optional>
#include <span>
#include <vector>

#include "keypoints/blazepose.h"
#include "keypoints/network.h"
#include "keypoints/view.h"

namespace vitruvian {

/// Finds the 33 landmarks in each of a set of views in two looks: at the silhouette's square, then at the
/// square that the first look asks for (turned so that the trunk is upright). Does not know who runs the
/// network:
///
///   ViewLandmarkDetector detector(views);
///   while (auto request = detector.next_request()) detector.accept(run(*request));
///   const std::vector<ViewLandmarks> landmarks = detector.result();
class ViewLandmarkDetector {
 public:
  struct Settings {
    bool second_pass = true;
    /// Keep the first look where it saw a body with more certainty than the second.
    bool prefer_presence = false;
  };

  /// @param views  must outlive the detector; may be empty.
  explicit ViewLandmarkDetector(std::span<const View> views) : ViewLandmarkDetector(views, Settings()) {}
  ViewLandmarkDetector(std::span<const View> views, const Settings& settings);

  /// The runs needed next, or nothing when the result is complete. The same request until accept() is called.
  std::optional<NetworkRequest> next_request() const;
  /// Takes the answer to the current request. @throws Error(internal) when nothing is asked or the reply does
  /// not fit.
  void accept(const NetworkReply& reply);

  /// Landmarks of each view, in the order of the views. @throws Error(internal) before the last reply.
  const std::vector<ViewLandmarks>& result() const;

 private:
  struct Look {
    std::size_t view;
    Region region;
  };

  std::span<const View> views_;
  Settings settings_;
  int pass_ = 1;
  std::vector<Look> looks_;  // asked for now; empty when complete
  std::vector<ViewLandmarks> landmarks_;
};

}  // namespace vitruvian
