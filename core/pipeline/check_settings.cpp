#include "pipeline/check_settings.h"

#include <algorithm>

#include "align/frame.h"
#include "base/error.h"
#include "pipeline/given_keypoints.h"
#include "pipeline/regions.h"

namespace vitruvian {
namespace {

/// Fewer do not tell how a body lies.
constexpr std::ptrdiff_t kLeastKeypoints = 3;

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::usage, what); }

std::optional<Vec3d> given_axis(Axis axis) {
  if (axis == Axis::automatic) return std::nullopt;
  return axis_vector(to_string(axis));
}

void check_alignment(const Settings& settings) {
  if (!settings.body_from_scan) return;
  if (settings.align == AlignMode::pca)
    refuse("--align-file and --align pca contradict each other: give one");
  if (settings.up != Axis::automatic || settings.front != Axis::automatic) {
    refuse("--align-file says already what is up and front: leave out --up and --front");
  }
  if (settings.unit != Unit::automatic)
    refuse("--align-file holds the unit's factor already: leave out --units");
}

void check_keypoints(const Settings& settings) {
  if (!settings.keypoints) return;
  const auto& joints = settings.keypoints->joints;
  const auto usable = std::count_if(joints.begin(), joints.end(),
                                    [](const auto& entry) { return entry.second.confidence > 0; });
  if (usable < kLeastKeypoints) {
    refuse("--keypoints: at least 3 joints with a confidence above 0 are needed, there are " +
           std::to_string(usable) + "; place more joints");
  }
  if (settings.init == InitMode::tpose || settings.init == InitMode::file) {
    refuse("--keypoints would not be used: --init " +
           std::string(settings.init == InitMode::tpose ? "tpose" : "FILE") +
           " starts without them; give one");
  }
  if (settings.keypoints->frame == KeypointFrame::scan && !settings.body_from_scan &&
      settings.align != AlignMode::pca) {
    rotation_from_keypoints(*settings.keypoints, given_axis(settings.up), given_axis(settings.front));
  }
}

void check_start(const Settings& settings, const Models& models) {
  if ((settings.init == InitMode::file) != settings.start.has_value())
    throw Error(ErrorCode::internal, "a start body belongs to InitMode::file");
  if (!settings.start) return;
  const StartBody& start = *settings.start;
  if (start.parameters.pose.cols() != models.body.joint_count()) {
    refuse("--init: its body has " + std::to_string(start.parameters.pose.cols()) + " joints, the model " +
           models.body.name + " has " + std::to_string(models.body.joint_count()) +
           "; start from a registration of the same model");
  }
  if (start.model_sha256 != models.body.sha256) {
    refuse("--init: it was registered with another model than " + models.body.name +
           " (the model's sha256 differs); start from a registration of the same model");
  }
}

}  // namespace

void check_settings(const Settings& settings, const Models& models) {
  if (settings.views != 2 && settings.views != 8) refuse("--views must be 2 or 8");
  check_alignment(settings);
  check_keypoints(settings);
  check_start(settings, models);
  if (settings.regions) check_regions(*settings.regions, models.body);
  if (settings.init == InitMode::keypoints && models.prior.vae.empty()) {
    refuse("--init keypoints needs a pose prior with an autoencoder, " +
           std::string("the one that was loaded has none: give another with --prior, or another --init"));
  }
}

}  // namespace vitruvian
