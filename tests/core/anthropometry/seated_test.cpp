#include "anthropometry/seated.h"

#include <gtest/gtest.h>

#include <map>

#include "anthropometry/posture.h"
#include "core/anthropometry/measured_body.h"

namespace vitruvian {
namespace {

using testing::measured_body;

Figure seated_figure(const Eigen::VectorXd& betas) {
  return {measured_body(), seated_posture(measured_body(), betas)};
}

std::map<std::string, Dimension> seated_dimensions(const Figure& figure, const FitQuality& fit = {}) {
  std::map<std::string, Dimension> result;
  for (const Dimension& d : measure_seated(figure, LandmarkSet(measured_body()), fit)) {
    EXPECT_TRUE(result.emplace(d.id, d).second) << d.id;
  }
  return result;
}

TEST(SeatedPosture, SitsAsDescribedInAnyShape) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const Figure figure = seated_figure(testing::moved_state(seed, 0).betas);
    const auto joint = [&](const std::string& segment) {
      return Vec3d(figure.skeleton.joints.col(measured_body().joint(segment_named(segment))));
    };
    for (const std::string side : {"left", "right"}) {
      const auto along = [&](const char* from, const char* to) {
        return Vec3d((joint(side + to) - joint(side + from)).normalized());
      };
      EXPECT_LT((along("_upper_leg", "_leg") - Vec3d::UnitZ()).norm(), 1e-9) << "thigh level";
      EXPECT_LT((along("_leg", "_foot") + Vec3d::UnitY()).norm(), 1e-9) << "lower leg vertical";
      EXPECT_LT((along("_forearm", "_hand") - Vec3d::UnitZ()).norm(), 1e-9) << "forearm level";
      EXPECT_LT(along("_arm", "_forearm").y(), -0.95) << "upper arm hangs";
      const int foot = measured_body().joint(segment_named(side + "_foot"));
      EXPECT_LT((figure.skeleton.global[static_cast<std::size_t>(foot)] - Mat3d::Identity()).norm(), 1e-9)
          << "feet flat";
    }
  }
}

TEST(SeatedDimensions, StandInTheRelationsOfTheirDefinitions) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const Figure figure = seated_figure(testing::moved_state(seed, 0).betas);
    const auto all = seated_dimensions(figure);
    const auto value = [&](const char* id) { return all.at(id).value_m; };
    const double whole = figure.vertices.row(1).maxCoeff() - figure.vertices.row(1).minCoeff();
    EXPECT_GT(value("sitting_height"), value("cervicale_height_sitting"));
    EXPECT_GT(value("cervicale_height_sitting"), value("shoulder_height_sitting_left"));
    for (const std::string side : {"_left", "_right"}) {
      const auto of = [&](const char* id) { return all.at(id + side).value_m; };
      EXPECT_GT(of("knee_height_sitting"), of("popliteal_height"));
      EXPECT_GT(of("buttock_knee_length"), of("buttock_popliteal_length"));
      EXPECT_LT(value("sitting_height") + of("popliteal_height"), whole + 0.08)
          << "seat and hollow of the knee lie at about one height";
      EXPECT_GT(value("sitting_height") + of("popliteal_height"), whole - 0.08);
    }
    for (const auto& [id, d] : all) {
      EXPECT_EQ(d.posture, Posture::sitting) << id;
      EXPECT_FALSE(d.course.empty()) << id;
      EXPECT_FALSE(d.uncertainty_m) << id << ": nothing is known of a fit";
    }
  }
}

TEST(SeatedDimensions, LeftAndRightOfTheSymmetricBodyAgree) {
  const auto all = seated_dimensions(seated_figure(BodyState::rest(testing::made_body()).betas));
  int pairs = 0;
  for (const auto& [id, d] : all) {
    if (d.side != "left") continue;
    ++pairs;
    EXPECT_NEAR(d.value_m, all.at(id.substr(0, id.size() - 4) + "right").value_m, 5e-4) << id;
  }
  EXPECT_EQ(pairs, 5);
}

TEST(SeatedDimensions, TheSeatLiesUnderBothButtocksAndThighs) {
  const Figure figure = seated_figure(testing::moved_state(4, 0).betas);
  const auto all = seated_dimensions(figure);
  const double seat = all.at("sitting_height").course.back().y();
  const double hollow = all.at("popliteal_height_left").course.front().y();
  EXPECT_NEAR(seat, hollow, 0.08);
  for (const char* segment : {"hips", "left_upper_leg", "right_upper_leg"}) {
    for (const int v : measured_body().vertices(segment_named(segment))) {
      if (figure.vertices(2, v) > figure.skeleton.joints(2, 0) + 0.1) continue;
      EXPECT_GE(figure.vertices(1, v), seat);
    }
  }
}

}  // namespace
}  // namespace vitruvian
