#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "body/model.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// A registration with every member set to something awkward: irrational numbers, an unseen segment, an
/// unknown keypoint.
inline Registration sample_registration() {
  Registration r;
  r.scan = {"J\u00f6rg \"1\".ply", std::string(64, 'a'), 120000, 239996};
  r.model = {"default", "vitruvian", std::string(64, 'b'), Gender::female, 6890, 13776,
             32,        24,          std::nullopt,         std::nullopt};
  r.alignment.body_from_scan << 0, 0.001, 0, -0.1 / 3, 0, 0, 0.001, -0.9, 0.001, 0, 0, 0.25, 0, 0, 0, 1;
  r.alignment.canonical_from_body << -1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1;
  r.alignment.unit = Unit::millimetre;
  r.alignment.metres_per_unit = 0.001;
  r.alignment.up = "z";
  r.alignment.front = "-x";
  r.alignment.method = "views";
  for (int j = 0; j < 22; ++j) {
    Keypoint k{std::string(kSmplJointNames[j]), Vec3d(j / 7.0, std::sqrt(j), -j), 0.25 * (j % 4),
               j % 2 ? KeypointSource::detected : KeypointSource::derived};
    if (j == 15) k = {"head", std::nullopt, 0, KeypointSource::none};
    r.keypoints.push_back(k);
  }
  BodyParameters p;
  p.betas = Eigen::VectorXd::LinSpaced(32, -2, std::numbers::pi);
  p.pose.resize(3, 24);
  for (Index i = 0; i < p.pose.size(); ++i) p.pose(i) = std::sin(static_cast<double>(i));
  p.translation_m = Vec3d(1e-17, -1.0 / 3, 123456.789);
  r.parameters = p;
  for (int j = 0; j < 24; ++j) {
    r.joints.push_back(
        {std::string(kSmplJointNames[j]), Vec3d(0.1, 0.2, j / 3.0), Vec3d(100, -200.5, 1000 * j / 3.0)});
  }
  SurfaceError e;
  e.observed = 0.875;
  for (int s = 0; s < 24; ++s) {
    SegmentError row{std::string(kSegmentNames[s]), s == 22 ? 0.25 : 1.0,
                     DistanceStatistics{100 + s, 1.5, 0.5, 1.25, 3, 9}};
    if (s == 22) row.statistics.reset();
    e.segments.push_back(row);
    if (row.statistics) row.statistics->mean_mm = 0.75;
    e.surface_segments.push_back(row);
  }
  e.all = {2000, 2.5, 1, 2.25, 6, 20};
  e.surface_all = {2000, 1.5, 1, 1.25, 5, 19};
  e.scan_to_model = {0, 3.5, 0, 2.25, 11, 42};
  r.surface_error = e;
  r.verdict = {VerdictStatus::doubtful, 0.4321, {"hardly seen in the scan: left hand index"}};
  r.timing_ms = {1.5, 2, 3, 4, 5, 6, 7, 0, 9, 40};
  r.settings.views = 2;
  r.settings.min_visibility = 0.1;
  r.settings.init = InitMode::keypoints;
  r.settings.gender = Gender::female;
  r.settings.betas = 16;
  r.settings.unit = Unit::inch;
  r.settings.up = Axis::minus_z;
  r.settings.front = Axis::x;
  r.settings.threads = 2;
  r.settings.seed = 4294967295u;
  return r;
}

}  // namespace vitruvian
