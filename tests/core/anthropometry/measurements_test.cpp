#include "anthropometry/measurements.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "core/anthropometry/measured_body.h"

namespace vitruvian {
namespace {

using testing::measured_body;
using testing::moved_state;

const Figure& standing() {
  static const Figure figure(measured_body(), BodyState::rest(testing::made_body()));
  return figure;
}

TEST(Measurements, SectionsAlongASegmentIntegrateToItsLimbsVolume) {
  // The middle of the thigh lies wholly on its own skin, so area x length there is the volume of the slice.
  const int thigh = segment_named("left_upper_leg");
  const double length = standing().axes[static_cast<std::size_t>(thigh)].length();
  double simpson = 0;
  const int steps = 40;
  std::vector<double> area;
  for (int i = 0; i <= steps; ++i) {
    const double t = 0.4 + 0.4 * i / steps;
    const auto loop = segment_section(standing(), thigh, t);
    ASSERT_TRUE(loop);
    area.push_back(measure_segment_section(standing(), thigh, *loop).area);
  }
  for (int i = 0; i + 2 <= steps; i += 2) {
    const auto k = static_cast<std::size_t>(i);
    simpson += 0.4 * length / steps / 3 * (area[k] + 4 * area[k + 1] + area[k + 2]);
  }
  // The same slice without sections: the part of the closed limb between two planes, from how its volume
  // above a plane changes; each triangle's prism down to the plane, clipped by weights of a fine split.
  const auto surface = measured_body().partition().closed(limb_of(thigh));
  const SegmentAxis& axis = standing().axes[static_cast<std::size_t>(thigh)];
  const Vec3d down = -axis.body_from_segment.col(1);
  const double from = 0.4 * length, to = 0.8 * length;
  double volume = 0;
  const int split = 12;
  for (Index f = 0; f < surface.faces.cols(); ++f) {
    const Vec3d a = standing().nodes.col(surface.faces(0, f)), b = standing().nodes.col(surface.faces(1, f)),
                c = standing().nodes.col(surface.faces(2, f));
    const double flux = (b - a).cross(c - a).dot(down) / 2 / (split * split);
    for (int i = 0; i < split; ++i) {
      for (int j = 0; j < 2 * (split - i) - 1; ++j) {
        // Centroids of the small triangles.
        const double u = (i + (j % 2 ? 2.0 : 1.0) / 3) / split, v = (j / 2 + (j % 2 ? 2.0 : 1.0) / 3) / split;
        const double depth = down.dot(a + u * (b - a) + v * (c - a) - axis.proximal);
        volume += flux * (std::clamp(depth, from, to) - from);
      }
    }
  }
  EXPECT_NEAR(simpson, volume, 1e-3 * volume);
}

TEST(Measurements, SegmentsOfARandomBodyAreOnesThatCouldBe) {
  const Figure figure(measured_body(), moved_state(4, 0.2));
  const BodyMeasures body = measure_body(figure);
  double volume = 0, mass = 0;
  for (int s = 0; s < kSegmentCount; ++s) {
    SCOPED_TRACE(kSegmentNames[static_cast<std::size_t>(s)]);
    const SegmentMeasure& m = body.segments[static_cast<std::size_t>(s)];
    volume += m.volume_m3;
    mass += m.mass_kg;
    EXPECT_GT(m.volume_m3, 0);
    EXPECT_GT(m.length_m, 0.02);
    EXPECT_NEAR(m.length_m, published_segment_length(figure, s), 0);
    EXPECT_LT(m.com_m.norm(), 0.3);
    // A body's principal moments obey the triangle inequality.
    const Vec3d moments = Eigen::SelfAdjointEigenSolver<Mat3d>(m.inertia_kgm2).eigenvalues();
    EXPECT_GT(moments[0], 0);
    EXPECT_GE(moments[0] + moments[1], moments[2] * (1 - 1e-9));
    EXPECT_GT(body.published[static_cast<std::size_t>(s)].volume_m3, 0);
  }
  EXPECT_NEAR(volume, body.volume_m3, 1e-9 * volume);
  EXPECT_NEAR(mass, body.mass_kg, 1e-9 * mass);
}

TEST(Measurements, NothingButTheNumbersOfTheFrameDependOnTheBodysPlace) {
  BodyState state = moved_state(6, 0.3);
  const BodyMeasures here = measure_body(Figure(measured_body(), state));
  const Mat3d turn = Eigen::AngleAxisd(1.1, Vec3d(1, -2, 0.5).normalized()).toRotationMatrix();
  state.rotation[0] = turn * state.rotation[0];
  state.translation += Vec3d(4, -3, 2);
  const BodyMeasures there = measure_body(Figure(measured_body(), state));
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const SegmentMeasure &a = here.segments[s], &b = there.segments[s];
    // Skinning weights are floats that sum to 1 within 1e-7.
    EXPECT_NEAR(a.volume_m3, b.volume_m3, 2e-6 * a.volume_m3);
    EXPECT_LT((a.com_m - b.com_m).norm(), 1e-6);
    EXPECT_LT((a.inertia_kgm2 - b.inertia_kgm2).norm(), 1e-6 * (1e-3 + a.inertia_kgm2.norm()));
    EXPECT_NEAR(here.published[s].volume_m3, there.published[s].volume_m3, 1e-7);
  }
}

TEST(Measurements, AnatomicalFrames) {
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentAxis& axis = standing().axes[static_cast<std::size_t>(s)];
    const Mat3d& turn = axis.body_from_segment;
    EXPECT_LT((turn.transpose() * turn - Mat3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(turn.determinant(), 1, 1e-12);
    EXPECT_LT((turn.transpose() * (axis.distal - axis.proximal) - Vec3d(0, -axis.length(), 0)).norm(), 1e-12);
  }
  // Right is -X in the body frame, forward +Z.
  const Mat3d thigh = standing().axes[1].body_from_segment;
  EXPECT_GT(thigh.col(0).z(), 0.9);
  EXPECT_LT(thigh.col(2).x(), -0.9);
  const Mat3d foot = standing().axes[7].body_from_segment;
  EXPECT_GT(foot.col(0).y(), 0.7) << "dorsal";
}

TEST(Measurements, PlacesAlongASegment) {
  const int arm = segment_named("right_arm");
  const double length = standing().axes[static_cast<std::size_t>(arm)].length();
  using From = SectionRequest::From;
  const SectionResult a = section_at(standing(), {arm, From::fraction, 0.25}),
                      b = section_at(standing(), {arm, From::proximal, 0.25 * length}),
                      c = section_at(standing(), {arm, From::distal, 0.75 * length});
  ASSERT_TRUE(a.measured && b.measured && c.measured);
  EXPECT_NEAR(a.t, b.t, 1e-12);
  EXPECT_NEAR(a.t, c.t, 1e-12);
  EXPECT_NEAR(a.measured->area, c.measured->area, 1e-9);
  EXPECT_THROW(section_at(standing(), {arm, From::proximal, length + 0.001}), Error);
  EXPECT_THROW(section_at(standing(), {arm, From::fraction, -0.1}), Error);
  const auto profile = section_profile(standing(), arm, 5);
  ASSERT_EQ(profile.size(), 5u);
  EXPECT_EQ(profile.front().t, 0);
  EXPECT_EQ(profile.back().t, 1);
  EXPECT_NEAR(profile[1].measured->area, a.measured->area, 1e-12);
}

TEST(Measurements, PublishedSlabAreaIsTheHullOfTheSegmentsVertices) {
  // A slab thicker than the segment holds all its vertices: the hull of their projection, by brute force in
  // 1,000 directions.
  const int thigh = segment_named("left_upper_leg");
  const double area = published_slab_area(standing(), thigh, 0.5, 10);
  const Mat3d& turn = standing().axes[static_cast<std::size_t>(thigh)].body_from_segment;
  double cauchy = 0;
  Eigen::VectorXd support(1001);
  const int steps = 1000;
  for (int i = 0; i <= steps; ++i) {
    const double a = 2 * std::numbers::pi * i / steps;
    double best = -1e9;
    for (const int v : measured_body().vertices(thigh)) {
      const Vec3d p = turn.transpose() * standing().vertices.col(v);
      best = std::max(best, std::cos(a) * p.x() + std::sin(a) * p.z());
    }
    support[i] = best;
  }
  // Area of a convex set from its support function h: half the integral of h^2 - h'^2.
  for (int i = 0; i < steps; ++i) {
    const double h = (support[i] + support[i + 1]) / 2,
                 slope = (support[i + 1] - support[i]) / (2 * std::numbers::pi / steps);
    cauchy += (h * h - slope * slope) / 2 * (2 * std::numbers::pi / steps);
  }
  EXPECT_NEAR(area, cauchy, 0.002 * area);
  EXPECT_EQ(published_slab_area(standing(), thigh, 0.5, 1e-9), 0);
}

}  // namespace
}  // namespace vitruvian
