#include "align/body_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "body_shapes.h"

namespace vitruvian {
namespace {

Points3f with(const Points3f& points, const Points3f& more) {
  Points3f all(3, points.cols() + more.cols());
  all << points, more;
  return all;
}

long kept(const BodyPoints& body, Index begin, Index end) {
  return std::count(body.keep.begin() + begin, body.keep.begin() + end, 1);
}

TEST(BodyPoints, CleanFigureIsKeptWhole) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Points3f figure = (random_rotation(random) * 1000).cast<float>() * scattered_figure(random, 20000);
    const BodyPoints body = find_body_points(figure);
    EXPECT_EQ(kept(body, 0, figure.cols()), figure.cols());
    EXPECT_EQ(body.floor, 0);
    EXPECT_EQ(body.strays, 0);
  }
}

TEST(BodyPoints, FloorAndStraysGo) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Points3f figure = scattered_figure(random, 20000);
    Points3f floor(3, 15000), strays(3, 60);
    for (Index i = 0; i < floor.cols(); ++i) {
      floor.col(i) =
          Vec3d(random.uniform(-0.8, 0.8), -0.005 + 0.002 * random.normal(), random.uniform(-0.8, 0.8))
              .cast<float>();
    }
    for (Index i = 0; i < strays.cols(); ++i) {
      strays.col(i) =
          Vec3d(random.uniform(1.2, 9), random.uniform(0.1, 9), random.uniform(1.2, 9)).cast<float>();
    }
    const Mat3f rotation = random_rotation(random).cast<float>();
    const BodyPoints body = find_body_points(rotation * with(with(figure, floor), strays));
    EXPECT_GT(kept(body, 0, 20000), 19000);
    EXPECT_LT(kept(body, 20000, 35000), 150);
    EXPECT_EQ(kept(body, 35000, 35060), 0);
    ASSERT_TRUE(body.has_floor());
    long on_floor = 0, body_on_floor = 0;
    for (Index i = 0; i < 35000; ++i) {
      const Points3f whole = rotation * with(figure, floor).col(i);
      (i < 20000 ? body_on_floor : on_floor) += body.on_floor(whole.col(0).cast<double>());
    }
    EXPECT_GT(on_floor, 14900);
    EXPECT_LT(body_on_floor, 1000);
    const double clean = diameter(figure, find_body_points(figure));
    EXPECT_NEAR(diameter(rotation * with(with(figure, floor), strays), body), clean, 0.06 * clean);
  }
}

// Who lay on a table has a flat back: a plane with everything on one side of it, but no floor.
TEST(BodyPoints, AFlatBackIsTheBodys) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Points3f figure = scattered_figure(random, 20000);
    figure.row(2) = figure.row(2).cwiseMax(-0.03f);
    EXPECT_GT((figure.row(2).array() == -0.03f).count(), 3000);
    const BodyPoints body = find_body_points(random_rotation(random).cast<float>() * figure);
    EXPECT_FALSE(body.has_floor());
    EXPECT_EQ(body.floor, 0);
    EXPECT_EQ(kept(body, 0, figure.cols()), figure.cols());
  }
}

TEST(BodyPoints, NonFiniteAndEmptyInput) {
  Random random(1);
  Points3f figure = scattered_figure(random, 2000);
  figure(1, 7) = std::nanf("");
  figure(2, 9) = INFINITY;
  const BodyPoints body = find_body_points(figure);
  EXPECT_EQ(body.keep[7], 0);
  EXPECT_EQ(body.keep[9], 0);
  EXPECT_EQ(body.strays, 2);
  EXPECT_TRUE(find_body_points(Points3f(3, 0)).keep.empty());
  EXPECT_EQ(diameter(Points3f(3, 0), {}), 0);
  const Points3f same = Points3f::Ones(3, 4);
  EXPECT_EQ(diameter(same, find_body_points(same)), 0);
}

TEST(BodyPoints, DiameterAndCentroidOfKnownShapes) {
  const Shape shape = skittle();
  const BodyPoints all = find_body_points(shape.vertices, shape.faces);
  EXPECT_NEAR(diameter(shape.vertices, all), 1.7, 0.02);
  Points3f square = (Points3f(3, 5) << 0, 1, 1, 0, 0.9f, 0, 0, 1, 1, 0.9f, 2, 2, 2, 2, 2).finished();
  const Faces faces = (Faces(3, 2) << 0, 0, 1, 2, 2, 3).finished();
  BodyPoints body;
  body.keep.assign(5, 1);
  // Area-weighted: the extra vertex without a face does not pull.
  EXPECT_LT((centroid(square, faces, body) - Vec3d(0.5, 0.5, 2)).norm(), 1e-6);
  EXPECT_LT((centroid(square, Faces(3, 0), body) - Vec3d(0.58, 0.58, 2)).norm(), 1e-6);
  body.keep[1] = 0;
  EXPECT_LT((centroid(square, faces, body) - Vec3d(1.0 / 3, 2.0 / 3, 2)).norm(), 1e-6);
}

TEST(BodyPoints, OnlyBodyRenumbersAndDropsCutTriangles) {
  DecimatedMesh mesh;
  mesh.vertices = (Points3f(3, 4) << 0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0).finished();
  mesh.normals = Points3f::Zero(3, 4);
  mesh.faces = (Faces(3, 2) << 0, 1, 1, 2, 3, 3).finished();
  mesh.source = {10, 11, 12, 13};
  BodyPoints body;
  body.keep = {0, 1, 1, 1};
  const DecimatedMesh result = only_body(mesh, body);
  ASSERT_EQ(result.vertices.cols(), 3);
  EXPECT_EQ(result.vertices(0, 0), 1);
  ASSERT_EQ(result.faces.cols(), 1);
  EXPECT_EQ(result.faces(0, 0), 0);
  EXPECT_EQ(result.faces(1, 0), 1);
  EXPECT_EQ(result.faces(2, 0), 2);
  EXPECT_EQ(result.source, (std::vector<int>{11, 12, 13}));
}

}  // namespace
}  // namespace vitruvian
