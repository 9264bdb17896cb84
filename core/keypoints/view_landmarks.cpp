#include "keypoints/view_landmarks.h"

#include "base/error.h"

namespace vitruvian {

ViewLandmarkDetector::ViewLandmarkDetector(std::span<const View> views, bool second_pass)
    : views_(views), second_pass_(second_pass), landmarks_(views.size()) {
  for (std::size_t k = 0; k < views_.size(); ++k) looks_.push_back({k, region_from_silhouette(views_[k])});
}

std::optional<NetworkRequest> ViewLandmarkDetector::next_request() const {
  if (looks_.empty()) return std::nullopt;
  NetworkRequest request{Network::landmarks, {}};
  for (const Look& look : looks_) request.inputs.push_back(landmarks_input(views_[look.view], look.region));
  return request;
}

void ViewLandmarkDetector::accept(const NetworkReply& reply) {
  if (looks_.empty()) throw Error(ErrorCode::internal, "ViewLandmarkDetector: a reply to no request");
  validate(NetworkRequest{Network::landmarks, std::vector<std::vector<float>>(looks_.size())}, reply);

  std::vector<Look> next;
  for (std::size_t k = 0; k < looks_.size(); ++k) {
    const Look& look = looks_[k];
    LandmarkReading reading = decode_landmarks(reply.outputs[k], look.region);
    if (pass_ == 1) {
      const Region region = region_from_auxiliary(reading.mid_hip, reading.circle_point);
      if (second_pass_ && is_plausible_region(region, look.region, views_[look.view])) {
        next.push_back({look.view, region});
      }
    }
    landmarks_[look.view] = std::move(reading.view);
  }
  looks_ = std::move(next);
  ++pass_;
}

const std::vector<ViewLandmarks>& ViewLandmarkDetector::result() const {
  if (!looks_.empty())
    throw Error(ErrorCode::internal, "ViewLandmarkDetector: asked for its result too early");
  return landmarks_;
}

}  // namespace vitruvian
