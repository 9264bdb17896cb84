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
  /// @param views        must outlive the detector; may be empty.
  /// @param second_pass  false: one look only, twice as fast, less sure (on 352 views of clothed bodies the
  /// second
  ///                     look takes the mean error from 3.7 to 3.3 % of the height).
  explicit ViewLandmarkDetector(std::span<const View> views, bool second_pass = true);

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
  bool second_pass_;
  int pass_ = 1;
  std::vector<Look> looks_;  // asked for now; empty when complete
  std::vector<ViewLandmarks> landmarks_;
};

}  // namespace vitruvian
