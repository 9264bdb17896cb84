#include "io/mesh_writer.h"

#include <Eigen/Dense>
#include <limits>
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include "core/io/test_files.h"

namespace vitruvian::test {
namespace {

struct Mesh {
  Points3d vertices;
  Faces faces;
  std::vector<std::uint8_t> colours;
  std::vector<float> values;

  explicit Mesh(double offset = 0) {
    const Solid solid;
    vertices.resize(3, 8);
    faces.resize(3, 12);
    for (int v = 0; v < 8; ++v) {
      for (int axis = 0; axis < 3; ++axis) vertices(axis, v) = solid.vertices[v][axis] / 3 + offset;
      for (int c = 0; c < 3; ++c) colours.push_back(static_cast<std::uint8_t>(solid.colour(v)[c]));
      values.push_back(0.25f * static_cast<float>(v));
    }
    for (int f = 0; f < 12; ++f)
      faces.col(f) = Eigen::Vector3i(solid.faces[f][0], solid.faces[f][1], solid.faces[f][2]);
  }
  MeshView view() const { return {vertices, faces, colours, values, "error_mm"}; }
};

double largest_difference(const Scan& scan, const Points3d& expected) {
  EXPECT_EQ(scan.vertices.cols(), expected.cols());
  return ((scan.vertices.cast<double>().colwise() + scan.origin) - expected).cwiseAbs().maxCoeff();
}

TEST(MeshWriter, PlyComesBack) {
  for (const double offset : {0.0, 1e3, 5e6}) {
    const Mesh mesh(offset);
    const std::string ply = to_ply(mesh.view());
    EXPECT_EQ(ply.find("property double x") != std::string::npos, offset > 0) << offset;
    EXPECT_NE(ply.find("property float error_mm"), std::string::npos);
    const Scan scan = read(ply);
    // Single precision around the scan's own centre.
    EXPECT_LT(largest_difference(scan, mesh.vertices), 1e-6) << offset;
    EXPECT_TRUE(scan.faces == mesh.faces);
    EXPECT_EQ(scan.colours, mesh.colours);
  }
}

TEST(MeshWriter, ObjComesBack) {
  for (const double offset : {0.0, 1e3, 5e6}) {
    const Mesh mesh(offset);
    const Scan scan = read(to_obj(mesh.view()));
    EXPECT_LT(largest_difference(scan, mesh.vertices), 1e-6) << offset;
    EXPECT_TRUE(scan.faces == mesh.faces);
    EXPECT_EQ(scan.colours, mesh.colours);
  }
}

Mat4d some_transform() {
  Mat4d body_from_scan = Mat4d::Identity();
  body_from_scan.topLeftCorner<3, 3>() =
      0.001 * Eigen::AngleAxisd(1.1, Vec3d(1, 2, 3).normalized()).toRotationMatrix();
  body_from_scan.topRightCorner<3, 1>() = Vec3d(0.1, -5000.0, 0.3);
  return body_from_scan;
}

TEST(MeshWriter, GlbOpensInTheBodyFrameAndItsExtrasLeadBackToTheScan) {
  const Mesh mesh(5e6);
  const Mat4d body_from_scan = some_transform();
  const std::string bytes = to_glb(mesh.view(), body_from_scan);

  const Scan scan = read(bytes);
  const Points3d in_body = (body_from_scan.topLeftCorner<3, 3>() * mesh.vertices).colwise() +
                           Vec3d(body_from_scan.topRightCorner<3, 1>());
  EXPECT_LT(largest_difference(scan, in_body), 1e-9);
  EXPECT_TRUE(scan.faces == mesh.faces);
  EXPECT_EQ(scan.colours, mesh.colours);

  // Another program's reader, and the extras.
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          static_cast<unsigned>(bytes.size())))
      << error;
  EXPECT_TRUE(warning.empty()) << warning;
  ASSERT_EQ(model.scenes.at(0).nodes.size(), 1u);
  const tinygltf::Value& numbers = model.nodes[0].extras.Get("scan_from_glb");
  ASSERT_EQ(numbers.ArrayLen(), 16u);
  Mat4d scan_from_glb;
  for (int k = 0; k < 16; ++k) scan_from_glb(k / 4, k % 4) = numbers.Get(k).GetNumberAsDouble();
  EXPECT_LT((scan_from_glb * body_from_scan - Mat4d::Identity()).cwiseAbs().maxCoeff(), 1e-6);
  const Points3d back =
      (scan_from_glb.topLeftCorner<3, 3>() * in_body).colwise() + Vec3d(scan_from_glb.topRightCorner<3, 1>());
  EXPECT_LT((back - mesh.vertices).cwiseAbs().maxCoeff(), 1e-6);
  const tinygltf::Primitive& primitive = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(model.accessors.at(primitive.attributes.at("_ERROR_MM")).count, 8u);
  EXPECT_EQ(model.accessors.at(primitive.attributes.at("POSITION")).minValues.size(), 3u);
}

TEST(MeshWriter, EqualInputGivesEqualBytes) {
  const Mesh mesh;
  EXPECT_EQ(to_glb(mesh.view(), some_transform()), to_glb(Mesh().view(), some_transform()));
  EXPECT_EQ(to_ply(mesh.view()), to_ply(Mesh().view()));
}

TEST(MeshWriter, RefusesContradictions) {
  const auto expect_refused = [](const Mesh& mesh, const char* what) {
    EXPECT_THROW(to_ply(mesh.view()), Error) << what;
    EXPECT_THROW(to_obj(mesh.view()), Error) << what;
    EXPECT_THROW(to_glb(mesh.view(), Mat4d::Identity()), Error) << what;
  };
  Mesh mesh;
  mesh.faces(1, 3) = 8;
  expect_refused(mesh, "index");
  mesh = Mesh();
  mesh.colours.pop_back();
  expect_refused(mesh, "colours");
  mesh = Mesh();
  mesh.values[3] = std::numeric_limits<float>::quiet_NaN();
  expect_refused(mesh, "value");
  mesh = Mesh();
  mesh.vertices(0, 0) = std::numeric_limits<double>::infinity();
  expect_refused(mesh, "coordinate");
  EXPECT_THROW(to_glb(Mesh().view(), Mat4d::Zero()), Error);
}

}  // namespace
}  // namespace vitruvian::test
