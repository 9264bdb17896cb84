#include "align/up_detector.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "base/error.h"
#include "body_shapes.h"
#include "keypoints/detector.h"

namespace vitruvian {
namespace {

constexpr int kSide = 224;

/// Stands in for the network: finds a skittle in the picture by the moments of its silhouette, "head" where
/// it tapers.
NetworkOutputs look_for_skittle(const std::vector<float>& picture) {
  NetworkOutputs outputs{std::vector<float>(2254 * 12, 0.0f), std::vector<float>(2254, -20.0f)};
  const float background = 190 / 127.5f - 1;
  std::vector<Eigen::Vector2d> pixels;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * kSide + x;
      if (std::fabs(picture[pixel] - background) < 0.02f &&
          std::fabs(picture[pixel + kSide * kSide] - background) < 0.02f) {
        continue;
      }
      pixels.emplace_back(x + 0.5, y + 0.5);
      mean += pixels.back();
    }
  }
  if (pixels.empty()) return outputs;
  mean /= static_cast<double>(pixels.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const auto& pixel : pixels) covariance += (pixel - mean) * (pixel - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  if (solver.eigenvalues()[1] < 2.5 * solver.eigenvalues()[0]) return outputs;
  Eigen::Vector2d up = solver.eigenvectors().col(1);
  double skewness = 0;
  for (const auto& pixel : pixels) skewness += std::pow(up.dot(pixel - mean), 3);
  if (skewness < 0) up = -up;
  const Eigen::Vector2f anchor = detector_anchors()[1000];
  const auto write = [&](int first, const Eigen::Vector2d& point) {
    outputs[0][12 * 1000 + first] = static_cast<float>(point.x()) - kSide * anchor.x();
    outputs[0][12 * 1000 + first + 1] = static_cast<float>(point.y()) - kSide * anchor.y();
  };
  write(0, mean);
  outputs[0][12 * 1000 + 2] = outputs[0][12 * 1000 + 3] = 60;
  write(4, mean);
  write(6, mean + 80 * up);
  write(8, mean + 30 * up);
  write(10, mean + 60 * up);
  outputs[1][1000] = 3;
  return outputs;
}

NetworkReply answer(const NetworkRequest& request) {
  NetworkReply reply;
  for (const auto& input : request.inputs) reply.outputs.push_back(look_for_skittle(input));
  return reply;
}

struct Found {
  std::vector<UpHypothesis> ups;
  int looks;
};

Found find_up(const Mat3d& scan_from_body) {
  const Execution execution(1);
  const Shape shape = skittle();
  const ViewSurface surface =
      prepare_surface(scan_from_body.cast<float>() * shape.vertices, shape.faces, Points3f(3, 0), execution);
  UpDetector detector(surface, execution);
  while (const auto request = detector.next_request()) {
    EXPECT_EQ(request->network, Network::detector);
    detector.accept(answer(*request));
  }
  return {detector.result(), detector.looks()};
}

TEST(UpDetector, FindsEveryAxisExactlyWithFewLooks) {
  for (const Vec3d& up :
       {Vec3d(1, 0, 0), Vec3d(-1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, -1, 0), Vec3d(0, 0, 1), Vec3d(0, 0, -1)}) {
    SCOPED_TRACE(up.transpose());
    const Found found = find_up(Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitY(), up).toRotationMatrix());
    EXPECT_EQ(found.ups[0].up, up);
    EXPECT_TRUE(found.ups[0].is_axis);
    EXPECT_GT(found.ups[0].score, 0.6);
    EXPECT_LE(found.looks, 5);
  }
}

TEST(UpDetector, FindsAnyDirection) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Mat3d scan_from_body = random_rotation(random);
    const Found found = find_up(scan_from_body);
    // Directions near a file axis are taken as that axis.
    const double slack = found.ups[0].is_axis ? 25.5 : 6;
    const double angle = std::acos(std::clamp(found.ups[0].up.dot(scan_from_body.col(1)), -1.0, 1.0));
    EXPECT_LT(angle * 180 / std::numbers::pi, slack);
    EXPECT_LE(found.looks, 19);
    for (std::size_t a = 0; a < found.ups.size(); ++a) {
      EXPECT_NEAR(found.ups[a].up.norm(), 1, 1e-6);
      if (a > 0) EXPECT_LE(found.ups[a].score, found.ups[a - 1].score);
      for (std::size_t b = 0; b < a; ++b) EXPECT_LT(found.ups[a].up.dot(found.ups[b].up), std::cos(0.5));
    }
  }
}

TEST(UpDetector, WithoutABodyTheLongerAxisIsNamedWithScoreZero) {
  const Execution execution(1);
  Shape shape = skittle();
  shape.vertices.row(1).swap(shape.vertices.row(2));
  const ViewSurface surface = prepare_surface(shape.vertices, shape.faces, Points3f(3, 0), execution);
  UpDetector detector(surface, execution);
  EXPECT_THROW(detector.result(), Error);
  while (const auto request = detector.next_request()) {
    NetworkReply reply;
    for (std::size_t k = 0; k < request->inputs.size(); ++k) {
      reply.outputs.push_back({std::vector<float>(2254 * 12, 0.0f), std::vector<float>(2254, -20.0f)});
    }
    detector.accept(reply);
  }
  ASSERT_EQ(detector.result().size(), 1u);
  EXPECT_EQ(detector.result()[0].up, Vec3d(0, 0, 1));
  EXPECT_EQ(detector.result()[0].score, 0);
  EXPECT_THROW(detector.accept({}), Error);
}

TEST(UpDetector, RefusesRepliesOfTheWrongSize) {
  const Execution execution(1);
  const Shape shape = skittle();
  const ViewSurface surface = prepare_surface(shape.vertices, shape.faces, Points3f(3, 0), execution);
  UpDetector detector(surface, execution);
  EXPECT_THROW(detector.accept({}), Error);
  NetworkReply reply = answer(*detector.next_request());
  reply.outputs[0][0].pop_back();
  EXPECT_THROW(detector.accept(reply), Error);
  detector.accept(answer(*detector.next_request()));
}

}  // namespace
}  // namespace vitruvian
