#include "core/io/test_files.h"

namespace vitruvian::test {
namespace {

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFour = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

TEST(Ply, BinaryOfBothByteOrdersWithForeignElementsAndListsAndOddOrder) {
  const Solid solid;
  std::vector<std::array<double, 3>> expected = solid.vertices;
  for (auto& vertex : expected) vertex[2] *= 8;
  for (const bool big_endian : {false, true}) {
    const Scan scan = read(binary_ply(big_endian));
    EXPECT_EQ(scan.format, ScanFormat::ply);
    expect_vertices(scan, expected);
    expect_faces(scan, solid.faces);
    expect_colours(scan, solid);
    EXPECT_TRUE(scan.notes.empty());
    EXPECT_FALSE(scan.metres_per_unit);
  }
}

TEST(Ply, AsciiIsReadByTokensNotByLines) {
  const Scan scan = read(kHeader +
                         "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                         "0 0 0 1 0 0\n\n0 1\n0 0 0 1 3 0 1 2 4\t0 1 2 3");
  expect_vertices(scan, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  expect_faces(scan, {{0, 1, 2}, {0, 1, 2}, {0, 2, 3}});
}

TEST(Ply, NormalsAndFloatColours) {
  const Scan scan = read(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float red\nproperty float green\n"
      "property float blue\nend_header\n0 0 0 0 0 1 0 0.5 1\n1 0 0 0 1 0 1 1 1\n0 1 0 nan 0 0 0 0 0\n0 0 1 1 "
      "0 0 0 0 0.2\n");
  ASSERT_EQ(scan.normals.cols(), 4);
  EXPECT_EQ(scan.normals.col(0), Vec3f(0, 0, 1));
  EXPECT_EQ(scan.normals.col(2), Vec3f(0, 0, 0)) << "a normal that is not finite becomes zero";
  EXPECT_EQ(scan.colours, (std::vector<std::uint8_t>{0, 128, 255, 255, 255, 255, 0, 0, 0, 0, 0, 51}));
  EXPECT_EQ(scan.faces.cols(), 0);
}

TEST(Ply, FloatColoursUpTo255) {
  const Scan scan = read(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float r\nproperty float g\nproperty float b\nend_header\n"
      "0 0 0 0 0 1\n1 0 0 200 10 1\n0 1 0 255 0 0\n0 0 1 1 2 3\n");
  EXPECT_EQ(scan.colours, (std::vector<std::uint8_t>{0, 0, 1, 200, 10, 1, 255, 0, 0, 1, 2, 3}));
}

TEST(Ply, TriangleStrips) {
  const Scan scan = read(kHeader + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                         kFour + "8 0 1 2 3 -1 3 2 1\n");
  expect_faces(scan, {{0, 1, 2}, {2, 1, 3}, {3, 2, 1}});
}

TEST(Ply, LargeCoordinatesKeepTheirDigits) {
  // Half a millimetre at 6000 km: beyond float, within double.
  const Scan scan = read(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double "
      "z\nend_header\n"
      "6000000.0005 1 2\n6000001.0005 1 2\n6000000.0005 2 2\n6000000.0005 1 3\n");
  EXPECT_NEAR(scan.origin.x() + scan.vertices(0, 0), 6000000.0005, 1e-7);
  EXPECT_NEAR(scan.vertices(0, 1) - scan.vertices(0, 0), 1, 1e-7);
  EXPECT_NEAR(scan.vertices.rowwise().sum().norm(), 0, 2) << "centred on the bounding box";
}

TEST(Ply, FacesWithRepeatedOrTooFewCornersAreDroppedWithANote) {
  const Scan scan = read(kHeader + "element face 4\nproperty list uchar int vertex_indices\nend_header\n" +
                         kFour + "3 0 1 2\n3 0 1 1\n2 0 1\n0\n");
  expect_faces(scan, {{0, 1, 2}});
  EXPECT_EQ(scan.notes, (std::vector<std::string>{"1 face with repeated vertices dropped",
                                                  "2 faces with fewer than three corners dropped"}));
}

TEST(Ply, AFewVerticesThatAreNotFiniteKeepTheirIndexAndLoseTheirFaces) {
  std::string body;
  for (int v = 0; v < 200; ++v)
    body += v == 100 ? "nan inf 0\n" : std::to_string(v) + " " + std::to_string(v * v) + " 0\n";
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 200\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const Scan scan = read(header + body + "3 0 1 100\n3 99 101 102\n");
  ASSERT_EQ(scan.vertices.cols(), 200);
  EXPECT_EQ(scan.vertices.col(100), scan.vertices.col(99));
  EXPECT_TRUE(scan.vertices.allFinite());
  expect_faces(scan, {{99, 101, 102}});
  ASSERT_EQ(scan.notes.size(), 1u);

  std::string first_bad = body;
  first_bad.replace(0, first_bad.find('\n'), "nan 0 0");
  const Scan other = read(header + first_bad + "3 2 1 3\n3 99 101 102\n");
  EXPECT_EQ(other.vertices.col(0), other.vertices.col(1)) << "put on the first finite one";
}

TEST(Ply, ManyVerticesThatAreNotFiniteAreAnError) {
  const Error error = error_of(kHeader + "end_header\n0 0 0\n1 0 0\nnan 1 0\n0 0 1\n", "bad.ply");
  EXPECT_EQ(error.code(), ErrorCode::bad_file);
  EXPECT_NE(std::string(error.what()).find("vertex 2"), std::string::npos) << error.what();
  EXPECT_EQ(error_of(kHeader + "end_header\nnan 0 0\nnan 0 0\nnan 1 0\nnan 0 1\n").code(),
            ErrorCode::bad_file);
}

TEST(Ply, TooFewDistinctPointsAreNoGeometry) {
  EXPECT_EQ(error_of(kHeader + "end_header\n0 0 0\n1 0 0\n0 1 0\n0 1 0\n").code(), ErrorCode::no_geometry);
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty "
                     "float z\nend_header\n")
                .code(),
            ErrorCode::no_geometry);
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nend_header\n").code(), ErrorCode::no_geometry);
}

TEST(Ply, ErrorsNameFilePlaceAndFault) {
  const auto expect = [](const std::string& content, const std::string& part) {
    const Error error = error_of(content, "my.ply");
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    EXPECT_EQ(std::string(error.what()).rfind("my.ply: ", 0), 0u) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  };
  expect(kHeader + "end_header\n0 0 0\n1 0 zero\n0 1 0\n0 0 1\n", "line 9");
  expect(kHeader + "end_header\n0 0 0\n1 0 0\n0 1.25 0\n0 0", "vertex 3 of 4");
  expect(
      kHeader + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + kFour + "3 0 1 4\n",
      "vertex 4");
  expect(
      kHeader + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + kFour + "3 0 1 -1\n",
      "face 0");
  expect(kHeader + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + kFour +
             "4000000000 0 1 2\n",
         "list");
  expect(
      "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n" +
          kFour,
      "line 3");
  expect(
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
      "float z\nend_header\n" +
          std::string(47, 'x'),
      "room for no more than 3");
  expect("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nend_header\n" + kFour,
         "x, y and z");
  expect("ply\nformat ascii 1.0\nelement vertex 4\nproperty flt x\n", "flt");
  expect("ply\nformat ascii 1.0\nelement vertex 4\n", "end_header");
  expect(kHeader + "end_header\n1e300 0 0\n-1e300 0 0\n0 1 0\n0 0 1\n", "1e15");
}

TEST(Ply, MicrosoftSpellingsOfNotANumberAreKnown) {
  const Error error = error_of(kHeader + "end_header\n0 0 0\n1.#QNAN 0 -1.#IND\n-nan(ind) 1 0\n0 0 1\n");
  EXPECT_NE(std::string(error.what()).find("not finite"), std::string::npos) << error.what();
}

TEST(Ply, AMillionVerticesOfBothEncodings) {
  constexpr int kRows = 1000;
  std::string ascii =
      "ply\nformat ascii 1.0\nelement vertex 1000000\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1996002\nproperty list uchar int vertex_indices\nend_header\n";
  std::string binary = ascii;
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kRows; ++column) {
      const float z = 0.125f * static_cast<float>((row * 7 + column * 13) % 64);
      ascii += std::to_string(row) + ".5 " + std::to_string(column) + ".25 " + std::to_string(z) + "\n";
      put(binary, static_cast<float>(row) + 0.5f);
      put(binary, static_cast<float>(column) + 0.25f);
      put(binary, z);
    }
  }
  for (int row = 0; row + 1 < kRows; ++row) {
    for (int column = 0; column + 1 < kRows; ++column) {
      const int corner = row * kRows + column;
      for (const std::array<int, 3>& face :
           {std::array<int, 3>{corner, corner + 1, corner + kRows},
            std::array<int, 3>{corner + 1, corner + kRows + 1, corner + kRows}}) {
        ascii += "3 " + std::to_string(face[0]) + " " + std::to_string(face[1]) + " " +
                 std::to_string(face[2]) + "\n";
        put(binary, std::uint8_t{3});
        for (const int index : face) put(binary, static_cast<std::int32_t>(index));
      }
    }
  }
  const Execution execution(2);
  const Scan from_ascii = read_scan(as_bytes(ascii), "a.ply", execution);
  const Scan from_binary = read_scan(as_bytes(binary), "b.ply", execution);
  ASSERT_EQ(from_binary.vertices.cols(), 1000000);
  ASSERT_EQ(from_binary.faces.cols(), 1996002);
  EXPECT_EQ(from_binary.origin, Vec3d(500, 499.75, 3.9375));
  EXPECT_EQ(from_binary.vertices.col(1001), Vec3f(-498.5f, -498.5f, 0.125f * ((7 + 13) % 64) - 3.9375f));
  EXPECT_EQ(from_ascii.origin, from_binary.origin);
  EXPECT_TRUE(from_ascii.vertices == from_binary.vertices);
  EXPECT_TRUE(from_ascii.faces == from_binary.faces);
}

TEST(Ply, CancelStopsReading) {
  Execution execution(1);
  execution.cancel();
  const std::string content = binary_ply(false);
  try {
    read_scan(as_bytes(content), "a.ply", execution);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace vitruvian::test
