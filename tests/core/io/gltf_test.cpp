#include "core/io/test_files.h"

namespace vitruvian::test {
namespace {

/// Four corners of a tetrahedron as float positions, then the u8 indices 0 1 2 3.
std::string four_binary() {
  std::string binary;
  for (const float value : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) put(binary, value);
  return binary + std::string("\0\1\2\3", 4);
}

/// A document around four_binary(): nodes and primitives as given.
std::string four_glb(const std::string& nodes, const std::string& primitives, const std::string& more = "") {
  return glb(R"({"asset":{"version":"2.0"},)" + more + R"("nodes":)" + nodes +
                 R"(,"meshes":[{"primitives":[)" + primitives + R"(]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":4,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":4}],"buffers":[{"byteLength":52}]})",
             four_binary());
}

const std::string kNode = R"([{"mesh":0}])";
const std::vector<std::array<double, 3>> kFour = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::string primitive(int mode, bool indexed) {
  return R"({"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) +
         (indexed ? R"(,"indices":1})" : "}");
}

TEST(Glb, PositionsNormalsColoursAndTheNodesTransform) {
  const Solid solid;
  const Scan scan = read(solid_glb(), "ein Körper – 人体.glb");
  EXPECT_EQ(scan.format, ScanFormat::glb);
  EXPECT_EQ(scan.file_name, "ein Körper – 人体.glb");
  std::vector<std::array<double, 3>> expected = solid.vertices;
  for (auto& vertex : expected) vertex[2] += 10;
  expect_vertices(scan, expected);
  expect_faces(scan, solid.faces);
  expect_colours(scan, solid);
  EXPECT_EQ(scan.normals.col(3), Vec3f(0, 0, 1));
  ASSERT_TRUE(scan.metres_per_unit);
  EXPECT_EQ(*scan.metres_per_unit, 1.0);
}

TEST(Glb, ModesOfPrimitives) {
  expect_faces(read(four_glb(kNode, primitive(5, true))), {{0, 1, 2}, {1, 3, 2}});
  expect_faces(read(four_glb(kNode, primitive(5, false))), {{0, 1, 2}, {1, 3, 2}});
  expect_faces(read(four_glb(kNode, primitive(6, true))), {{0, 1, 2}, {0, 2, 3}});
  expect_faces(read(four_glb(kNode, primitive(4, true))), {{0, 1, 2}});
  const Scan points = read(four_glb(kNode, primitive(0, false)));
  expect_vertices(points, kFour);
  EXPECT_EQ(points.faces.cols(), 0);
  EXPECT_EQ(error_of(four_glb(kNode, primitive(1, true))).code(), ErrorCode::no_geometry);
}

TEST(Glb, PrimitivesThatShareTheirPositionsShareVertices) {
  const Scan scan = read(four_glb(kNode, primitive(6, true) + "," + primitive(4, false)));
  expect_vertices(scan, kFour);
  EXPECT_EQ(scan.faces.cols(), 3);
}

TEST(Glb, TransformsMultiplyDownTheTreeInSceneOrder) {
  const Scan scan = read(four_glb(
      R"([{"children":[1,2],"scale":[2,2,2]},{"mesh":0,"translation":[1,2,3],"rotation":[0,0,0.70710678118654752,0.70710678118654752]},
{"mesh":0,"matrix":[1,0,0,0, 0,-1,0,0, 0,0,1,0, 5,6,7,1]}])",
      primitive(4, true)));
  ASSERT_EQ(scan.vertices.cols(), 8);
  const auto at = [&](int v) { return Vec3d(scan.origin + scan.vertices.col(v).cast<double>()); };
  EXPECT_LT((at(0) - Vec3d(2, 4, 6)).norm(), 1e-6);
  EXPECT_LT((at(1) - Vec3d(2, 6, 6)).norm(), 1e-6) << "x turned onto y";
  EXPECT_LT((at(4) - Vec3d(10, 12, 14)).norm(), 1e-6);
  EXPECT_LT((at(6) - Vec3d(10, 10, 14)).norm(), 1e-6) << "mirrored";
  expect_faces(scan, {{0, 1, 2}, {4, 6, 5}});
}

TEST(Glb, OnlyTheChosenSceneIsRead) {
  const Scan scan = read(four_glb(R"([{"mesh":0,"translation":[9,9,9]},{"mesh":0}])", primitive(4, true),
                                  R"("scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}],)"));
  expect_vertices(scan, kFour);
}

TEST(Gltf, EmbeddedDataAndQuantisedPositions) {
  for (const NamedContent& file : one_of_every_format()) {
    if (file.name != "body.gltf") continue;
    const Scan scan = read(file.content, "x");
    EXPECT_EQ(scan.format, ScanFormat::gltf);
    expect_vertices(scan, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 0, 4}, {0, 4, 4}});
    expect_faces(scan, {{0, 1, 2}, {3, 4, 5}});
  }
}

void expect_error(const std::string& content, ErrorCode code, const std::string& part) {
  const Error error = error_of(content, "a.glb");
  EXPECT_EQ(error.code(), code) << error.what();
  EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
}

TEST(Gltf, Errors) {
  const std::string triangles = primitive(4, true);
  const auto replaced = [&](const std::string& from, const std::string& to) {
    // The JSON chunk's length is in the header, so replacements keep it.
    std::string content = four_glb(kNode, triangles);
    const std::size_t at = content.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    EXPECT_EQ(from.size(), to.size());
    return content.replace(at, from.size(), to);
  };
  expect_error(replaced("\"count\":4,\"type\":\"VEC3\"", "\"count\":5,\"type\":\"VEC3\""),
               ErrorCode::bad_file, "accessors[0]");
  expect_error(replaced("\"byteLength\":48", "\"byteLength\":99"), ErrorCode::bad_file, "bufferViews[0]");
  expect_error(replaced("\"byteLength\":52", "\"byteLength\":99"), ErrorCode::bad_file, "buffers[0]");
  expect_error(replaced("5126", "5130"), ErrorCode::bad_file, "componentType");
  expect_error(replaced("\"indices\":1", "\"indices\":7"), ErrorCode::bad_file, "accessors[7]");
  expect_error(replaced("\"indices\":1", "\"indices\":0"), ErrorCode::bad_file, "SCALAR");
  expect_error(replaced("\"mesh\":0", "\"mesh\":3"), ErrorCode::bad_file, "meshes[3]");
  expect_error(replaced("\"count\":4", "\"count\":-"), ErrorCode::bad_file, "JSON");
  std::string index_out_of_range = four_glb(kNode, triangles);
  index_out_of_range[index_out_of_range.size() - 2] = '\7';
  expect_error(index_out_of_range, ErrorCode::bad_file, "index 7");
  expect_error(four_glb(R"([{"children":[0],"mesh":0}])", triangles, R"("scenes":[{"nodes":[0]}],)"),
               ErrorCode::bad_file, "twice");
  expect_error(four_glb(R"([{"mesh":0,"rotation":[0,0,0,0]}])", triangles), ErrorCode::bad_file,
               "quaternion");
  expect_error(
      four_glb(kNode, R"({"attributes":{"POSITION":0},"extensions":{"KHR_draco_mesh_compression":{}}})"),
      ErrorCode::unsupported_format, "Draco");
  std::string cut = four_glb(kNode, triangles);
  cut.pop_back();
  expect_error(cut, ErrorCode::bad_file, "cut short");
  cut[4] = 1;
  expect_error(cut, ErrorCode::unsupported_format, "version 1");
  expect_error(
      R"({"asset":{},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,
"count":4,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":48}],"buffers":[{"byteLength":48,"uri":"other.bin"}]})",
      ErrorCode::unsupported_format, "other.bin");
  expect_error(R"({"asset":)" + std::string(100000, '['), ErrorCode::bad_file, "deeper");
}

TEST(Gltf, ScenesThatMultiplyAMeshBeyondTheFilesSizeAreRefused) {
  std::string nodes = "[";
  for (int n = 0; n < 3000; ++n) nodes += std::string(n ? "," : "") + R"({"mesh":0})";
  std::string primitives;
  for (int p = 0; p < 200; ++p) primitives += std::string(p ? "," : "") + primitive(4, true);
  expect_error(four_glb(nodes + "]", primitives), ErrorCode::bad_file, "too often");
}

}  // namespace
}  // namespace vitruvian::test
