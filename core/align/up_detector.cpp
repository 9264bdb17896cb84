#include "align/up_detector.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "keypoints/detector.h"

namespace vitruvian {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Error of a picture's roll that halves its vote, and the least angle between two distinct hypotheses.
constexpr double kRollScale = 20 * kDegree, kDistinct = 30 * kDegree;
/// Weight with which a picture without a body speaks against every direction that it should have shown.
constexpr double kBlindWeight = 0.3;
constexpr std::size_t kMostHypotheses = 4;
constexpr Framing kFraming{256, 0.72f};

const std::array<Vec3d, 6>& file_axes() {
  static const std::array<Vec3d, 6> axes{Vec3d(0, 1, 0),  Vec3d(0, 0, 1),  Vec3d(1, 0, 0),
                                         Vec3d(0, -1, 0), Vec3d(0, 0, -1), Vec3d(-1, 0, 0)};
  return axes;
}

/// How much a picture from `toward_viewer` can tell about `up`: nothing when it looks along it.
double leverage(const Vec3d& up, const Vec3d& toward_viewer) {
  const double along = up.dot(toward_viewer);
  return std::max(0.0, 1 - along * along);
}

/// Angle in the picture between the body's up as seen and `up` projected.
double roll_error(const Vec3d& up, const Vec3d& toward_viewer, const Vec3d& up_in_picture) {
  const Vec3d projected = up - up.dot(toward_viewer) * toward_viewer;
  if (projected.norm() < 1e-9) return std::numbers::pi;
  return std::acos(std::clamp(projected.normalized().dot(up_in_picture), -1.0, 1.0));
}

double vote(double roll_error) { return 1 / (1 + std::pow(roll_error / kRollScale, 2)); }

/// Half of the 26 directions to a cube's corners and edges, the face directions left out; signs mixed so that
/// the body is seen from all round.
std::vector<std::pair<Vec3d, Vec3d>> sphere_looks() {
  std::vector<std::pair<Vec3d, Vec3d>> looks;
  for (const Vec3d& d :
       {Vec3d(1, 1, 1), Vec3d(-1, 1, -1), Vec3d(1, -1, -1), Vec3d(-1, -1, 1), Vec3d(1, 0, 1), Vec3d(-1, 0, 1),
        Vec3d(0, 1, -1), Vec3d(0, -1, -1), Vec3d(1, -1, 0), Vec3d(-1, -1, 0)}) {
    looks.emplace_back(d.normalized(), d.x() == 0 && d.z() == 0 ? Vec3d::UnitZ() : Vec3d::UnitY());
  }
  return looks;
}

}  // namespace

UpDetector::UpDetector(const ViewSurface& surface, const Execution& execution)
    : surface_(surface), execution_(execution) {
  look(
      {{Vec3d::UnitX(), Vec3d::UnitY()}, {Vec3d::UnitY(), Vec3d::UnitZ()}, {Vec3d::UnitZ(), Vec3d::UnitY()}});
}

void UpDetector::look(const std::vector<std::pair<Vec3d, Vec3d>>& directions_and_ups) {
  std::vector<Camera> cameras;
  for (const auto& [direction, up] : directions_and_ups) {
    cameras.push_back(framing_camera(surface_.vertices, direction.cast<float>(), up.cast<float>(), kFraming));
  }
  views_ = render_views(surface_, cameras, ViewStyle(), execution_);
  request_ = {Network::detector, {}};
  for (const View& view : views_) request_.inputs.push_back(detector_input(view));
}

std::optional<NetworkRequest> UpDetector::next_request() const {
  if (stage_ == Stage::done) return std::nullopt;
  return request_;
}

void UpDetector::accept(const NetworkReply& reply) {
  if (stage_ == Stage::done) throw Error(ErrorCode::internal, "a network reply that nobody asked for");
  validate(request_, reply);
  for (std::size_t k = 0; k < views_.size(); ++k) {
    const Camera& camera = views_[k].camera;
    Observation seen{camera.toward_viewer.cast<double>(), Vec3d::Zero(), 0};
    if (const auto detection = decode_detection(reply.outputs[k], views_[k])) {
      seen.score = detection->score;
      seen.up_in_picture = std::cos(detection->roll) * camera.up.cast<double>() +
                           std::sin(detection->roll) * camera.right.cast<double>();
    }
    observations_.push_back(seen);
  }
  advance();
}

void UpDetector::confirm(int hypotheses) {
  std::vector<std::pair<Vec3d, Vec3d>> looks;
  const std::vector<UpHypothesis> candidates = ranked();
  for (int h = 0; h < hypotheses && h < static_cast<int>(candidates.size()); ++h) {
    const Vec3d up = candidates[h].up, side = up.unitOrthogonal(), front = side.cross(up);
    // Upright pictures halfway between those taken already, nearly always oblique views of the body.
    looks.emplace_back((front + side).normalized(), up);
    looks.emplace_back((front - side).normalized(), up);
  }
  look(looks);
}

void UpDetector::advance() {
  constexpr double kSure = 0.62;
  constexpr int kSureViews = 4;
  const std::vector<UpHypothesis> candidates = ranked();
  switch (stage_) {
    case Stage::axes:
      if (candidates.front().score >= kSure && candidates.front().views >= 2) {
        stage_ = Stage::confirm_axes;
        confirm(1);
        return;
      }
      stage_ = Stage::sphere;
      look(sphere_looks());
      return;
    case Stage::confirm_axes:
      if (candidates.front().score >= kSure && candidates.front().views >= kSureViews) {
        stage_ = Stage::done;
        return;
      }
      stage_ = Stage::sphere;
      look(sphere_looks());
      return;
    case Stage::sphere:
      stage_ = Stage::confirm;
      confirm(2);
      return;
    case Stage::confirm:
    case Stage::done:
      stage_ = Stage::done;
      return;
  }
}

double UpDetector::agreement(const Vec3d& up) const {
  double agreeing = 0, all = 1e-9;
  for (const Observation& seen : observations_) {
    const double told = leverage(up, seen.toward_viewer);
    if (seen.score > 0) {
      const double weight = seen.score * seen.score * told;
      agreeing += weight * vote(roll_error(up, seen.toward_viewer, seen.up_in_picture));
      all += weight;
    } else {
      all += kBlindWeight * told * told;
    }
  }
  return agreeing / all;
}

Vec3d UpDetector::refined(Vec3d up) const {
  constexpr int kIterations = 6;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    // Each picture confines the direction to a plane: that of its line of sight and the up seen in it.
    Mat3d normal = Mat3d::Zero();
    for (const Observation& seen : observations_) {
      if (seen.score <= 0) continue;
      const double error = roll_error(up, seen.toward_viewer, seen.up_in_picture);
      if (error > 3 * kRollScale) continue;
      const Vec3d across = seen.toward_viewer.cross(seen.up_in_picture);
      const double v = vote(error);
      normal += seen.score * seen.score * v * v * across * across.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Mat3d> solver(normal);
    // With one plane only, every direction in it would do: stay.
    if (!(solver.eigenvalues()[1] > 1e-3)) return up;
    const Vec3d next = solver.eigenvectors().col(0);
    up = next.dot(up) < 0 ? Vec3d(-next) : next;
  }
  return up;
}

std::vector<UpHypothesis> UpDetector::ranked() const {
  constexpr double kAxisAngle = 25 * kDegree, kAxisShare = 0.9;
  std::vector<Vec3d> candidates(file_axes().begin(), file_axes().end());
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    const Observation& a = observations_[i];
    if (a.score <= 0) continue;
    candidates.push_back(a.up_in_picture);
    for (std::size_t j = i + 1; j < observations_.size(); ++j) {
      const Observation& b = observations_[j];
      if (b.score <= 0) continue;
      const Vec3d crossing =
          a.toward_viewer.cross(a.up_in_picture).cross(b.toward_viewer.cross(b.up_in_picture));
      if (crossing.norm() < 0.1) continue;
      candidates.push_back(crossing.normalized());
      candidates.push_back(-crossing.normalized());
    }
  }
  std::vector<std::pair<double, Vec3d>> scored;
  for (const Vec3d& candidate : candidates) scored.emplace_back(agreement(candidate), candidate);
  std::stable_sort(scored.begin(), scored.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });

  std::vector<UpHypothesis> hypotheses;
  for (const auto& [score, candidate] : scored) {
    if (hypotheses.size() == kMostHypotheses) break;
    UpHypothesis hypothesis{refined(candidate), 0, 0, false};
    if (agreement(hypothesis.up) < score) hypothesis.up = candidate;
    hypothesis.score = agreement(hypothesis.up);
    for (const Vec3d& axis : file_axes()) {
      if (axis.dot(hypothesis.up) > std::cos(kAxisAngle) &&
          agreement(axis) >= kAxisShare * hypothesis.score) {
        hypothesis.up = axis;
        hypothesis.is_axis = true;
      }
    }
    const bool distinct = std::all_of(hypotheses.begin(), hypotheses.end(), [&](const UpHypothesis& earlier) {
      return earlier.up.dot(hypothesis.up) < std::cos(kDistinct);
    });
    if (!distinct) continue;
    double certainty = 0, weight = 0;
    for (const Observation& seen : observations_) {
      if (seen.score <= 0 || leverage(hypothesis.up, seen.toward_viewer) < 0.3) continue;
      const double v = vote(roll_error(hypothesis.up, seen.toward_viewer, seen.up_in_picture));
      if (v > 0.5) ++hypothesis.views;
      certainty += v * seen.score;
      weight += v;
    }
    hypothesis.score *= weight > 0 ? certainty / weight : 0;
    hypotheses.push_back(hypothesis);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const UpHypothesis& a, const UpHypothesis& b) { return a.score > b.score; });
  return hypotheses;
}

std::vector<UpHypothesis> UpDetector::result() const {
  if (stage_ != Stage::done)
    throw Error(ErrorCode::internal, "the up direction is asked for before it is known");
  std::vector<UpHypothesis> hypotheses = ranked();
  const bool seen = std::any_of(observations_.begin(), observations_.end(),
                                [](const Observation& observation) { return observation.score > 0; });
  if (!seen) {
    const Eigen::AlignedBox3f box(surface_.vertices.rowwise().minCoeff(),
                                  surface_.vertices.rowwise().maxCoeff());
    const Vec3f extent = box.sizes();
    return {{extent.z() > extent.y() ? Vec3d::UnitZ() : Vec3d::UnitY(), 0.0, 0, true}};
  }
  return hypotheses;
}

}  // namespace vitruvian
