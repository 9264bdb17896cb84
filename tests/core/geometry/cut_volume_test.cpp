#include "geometry/cut_volume.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/random.h"

namespace vitruvian {
namespace {

Vec3d anywhere(Random& random) {
  return {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
}

TEST(CutVolume, TurnedBoxHoldsWhatItsOwnAxesSay) {
  const Mat3d turn = Eigen::AngleAxisd(0.7, Vec3d(1, 2, -1).normalized()).toRotationMatrix();
  const Vec3d centre(0.3, -0.2, 0.1), half(0.5, 1.2, 0.8);
  CutVolume box;
  Mat4d scan_from_box = Mat4d::Identity();
  scan_from_box.topLeftCorner<3, 3>() = turn * half.asDiagonal();
  scan_from_box.topRightCorner<3, 1>() = centre;
  box.volume_from_scan = scan_from_box.inverse();
  Random random(11);
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3d point = anywhere(random), local = turn.transpose() * (point - centre);
    const bool expected = (local.cwiseAbs().array() <= half.array()).all();
    EXPECT_EQ(box.contains(point), expected) << "seed 11, point " << i;
    inside += expected;
  }
  EXPECT_GT(inside, 10);
  EXPECT_LT(inside, 490);
}

/// A camera at `eye` looking along -Z that sees x, y in -1..1 at distance 1.
Mat4d camera_at(const Vec3d& eye) {
  Mat4d view = Mat4d::Identity(), projection = Mat4d::Identity();
  view.topRightCorner<3, 1>() = -eye;
  projection.row(2) << 0, 0, -1, -0.2;
  projection.row(3) << 0, 0, -1, 0;
  return projection * view;
}

TEST(CutVolume, LassoCutsAConeInFrontOfTheCameraOnly) {
  CutVolume lasso;
  lasso.shape = CutVolume::Shape::lasso;
  lasso.volume_from_scan = camera_at({0, 0, 3});
  lasso.polygon = {{-0.1, -0.1}, {0.3, -0.1}, {0.3, 0.2}, {-0.1, 0.2}};
  EXPECT_TRUE(lasso.contains({0, 0, 0}));
  EXPECT_TRUE(lasso.contains({0.85, 0, 0})) << "3 m off, 0.85 / 3 < 0.3";
  EXPECT_FALSE(lasso.contains({0.85, 0, 1})) << "2 m off, 0.85 / 2 > 0.3";
  EXPECT_FALSE(lasso.contains({0, 0, 4})) << "behind the camera";
  EXPECT_FALSE(lasso.contains({0, 0, 3})) << "in the camera";
}

TEST(CutVolume, LassoMayBeConcaveAndCrossItself) {
  CutVolume lasso;
  lasso.shape = CutVolume::Shape::lasso;
  // A U: the notch is outside.
  lasso.polygon = {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  EXPECT_TRUE(lasso.contains({0.5, 1.5, 7}));
  EXPECT_TRUE(lasso.contains({2.5, 1.5, -7}));
  EXPECT_FALSE(lasso.contains({1.5, 1.5, 0}));
  lasso.polygon = {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}};
  EXPECT_TRUE(lasso.contains({-0.9, 0, 0}));
  EXPECT_FALSE(lasso.contains({0, 0.9, 0}));
}

TEST(CutVolume, CutsOneAfterTheOtherFarFromTheOrigin) {
  const Vec3d origin(250000, -80000, 1200);
  Random random(5);
  Points3f points(3, 300);
  for (Index i = 0; i < points.cols(); ++i) points.col(i) = anywhere(random).cast<float>();
  CutVolume keep, cut;
  keep.remove = CutVolume::Remove::outside;
  keep.volume_from_scan.topRightCorner<3, 1>() = -origin;
  cut.volume_from_scan.topLeftCorner<3, 3>() *= 2;
  cut.volume_from_scan.topRightCorner<3, 1>() = -2 * origin;
  const std::vector<std::uint8_t> kept = uncut_points({keep, cut}, points, origin);
  for (Index i = 0; i < points.cols(); ++i) {
    const float reach = points.col(i).cwiseAbs().maxCoeff();
    EXPECT_EQ(kept[static_cast<std::size_t>(i)] != 0, reach <= 1 && reach > 0.5) << "seed 5, point " << i;
  }
  EXPECT_EQ(uncut_points({}, points, origin), std::vector<std::uint8_t>(300, 1));
}

TEST(CutVolume, FacesKeepTheirShapeUnderNewNumbers) {
  Faces faces(3, 3);
  faces << 0, 1, 4, 1, 2, 3, 2, 3, 2;
  const Faces left = uncut_faces(faces, {0, 1, 1, 1, 1});
  ASSERT_EQ(left.cols(), 2);
  EXPECT_EQ(left.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(left.col(1), Eigen::Vector3i(3, 2, 1));
  EXPECT_EQ(uncut_faces(faces, {1, 1, 1, 1, 1}), faces);
  EXPECT_EQ(uncut_faces(faces, {0, 0, 0, 0, 0}).cols(), 0);
}

}  // namespace
}  // namespace vitruvian
