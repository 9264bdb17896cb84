#pragma once

#include <Eigen/Geometry>
#include <string>

#include "align/frame.h"
#include "core/fit/fit_fixtures.h"
#include "keypoints/blazepose.h"
#include "pipeline/pipeline.h"

namespace vitruvian::testing {

inline const Models& models() {
  static const Models all = [] {
    const std::string file = VITRUVIAN_SOURCE_DIR "/models/landmarks.json";
    const std::vector<std::byte> bytes = testing::file_bytes(file);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return Models{default_body(), testing::shipped_prior(), landmarks_from_json(text, file), std::nullopt,
                  std::nullopt};
  }();
  return all;
}

/// A body that stands with hanging arms, one knee bent a little.
inline BodyState standing() {
  BodyState state = BodyState::rest(default_body());
  const auto turn = [&](int joint, double angle, const Vec3d& axis) {
    state.rotation[joint] = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  turn(16, -1.1, Vec3d::UnitZ());
  turn(17, 1.0, Vec3d::UnitZ());
  turn(18, -0.4, Vec3d::UnitY());
  turn(5, 0.3, Vec3d::UnitX());
  for (Index k = 0; k < 6; ++k) state.betas[k] = k % 2 ? -0.7 : 0.8;
  return state;
}

/// Survey coordinates in millimetres, Z up.
inline Mat4d scan_from_body() {
  Mat4d transform = Mat4d::Identity();
  Mat3d z_up;
  z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  transform.topLeftCorner<3, 3>() = 1000 * Eigen::AngleAxisd(0.4, Vec3d::UnitZ()).toRotationMatrix() * z_up;
  transform.topRightCorner<3, 1>() = Vec3d(250000, -80000, 1200);
  return transform;
}

inline Points3d to_scan(const Points3d& body_points) {
  const Mat4d t = scan_from_body();
  return (t.topLeftCorner<3, 3>() * body_points).colwise() + t.topRightCorner<3, 1>();
}

inline Scan scan_of(const BodyState& state) {
  Scan scan;
  scan.file_name = "standing.ply";
  scan.origin = scan_from_body().topRightCorner<3, 1>();
  scan.vertices =
      (to_scan(posed_vertices<double>(default_body(), state)).colwise() - scan.origin).cast<float>();
  scan.faces = default_body().faces;
  return scan;
}

/// Answers from the true body instead of from the pictures.
class AllKnowingNetwork {
 public:
  explicit AllKnowingNetwork(const BodyState& state) {
    const Skeleton skeleton = pose_skeleton(default_body(), state);
    landmarks_scan_ = Points3d::Zero(3, kLandmarkCount);
    for (const LandmarkOffset& o : models().landmarks) {
      landmarks_scan_.col(o.landmark) =
          skeleton.joints.col(o.joint) + skeleton.global[o.frame_joint] * o.offset;
      known_[o.landmark] = true;
    }
    landmarks_scan_ = to_scan(landmarks_scan_);
  }

  NetworkReply run(const RegistrationPipeline& pipeline, const NetworkRequest& request) const {
    const PreparedScan& prepared = pipeline.prepared();
    const Mat4d upright_from_scan = body_from_scan(
        align_pca(prepared.surface.vertices, default_body().v_template), prepared.centroid, 0.001);
    const Points3d seen = (upright_from_scan.topLeftCorner<3, 3>() * landmarks_scan_).colwise() +
                          upright_from_scan.topRightCorner<3, 1>();
    const std::vector<View>& views = pipeline.landmark_stage()->views();
    EXPECT_EQ(request.inputs.size(), views.size());
    NetworkReply reply;
    for (const View& view : views) {
      const Region region = region_from_silhouette(view);
      NetworkOutputs outputs{std::vector<float>(195, 0), {1}, std::vector<float>(39 * 64 * 64, -20)};
      for (int l = 0; l < kLandmarkCount; ++l) {
        const Eigen::Vector2f crop = region.crop_from_image(view.camera.project(seen.col(l).cast<float>()),
                                                            static_cast<float>(kLandmarkCropSize));
        const float sureness = known_[l] ? 8 : -20;
        const float values[5] = {crop.x(), crop.y(), 0, sureness, sureness};
        std::copy_n(values, 5, outputs[0].begin() + 5 * l);
      }
      // Points 33 and 34 coincide: no second look.
      reply.outputs.push_back(std::move(outputs));
    }
    return reply;
  }

 private:
  Points3d landmarks_scan_;
  std::array<bool, kLandmarkCount> known_{};
};

/// The pipeline that AllKnowingNetwork answers: aligned by PCA, so that no detector is asked.
inline Settings pca_settings() {
  Settings settings;
  settings.align = AlignMode::pca;
  settings.unit = Unit::millimetre;
  settings.threads = 2;
  return settings;
}

}  // namespace vitruvian::testing
