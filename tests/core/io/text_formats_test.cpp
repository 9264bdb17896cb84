#include "core/io/test_files.h"

namespace vitruvian::test {
namespace {

const std::string kFourV = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::vector<std::array<double, 3>> kFour = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

void expect_error(const std::string& content, const std::string& name, ErrorCode code,
                  const std::string& part) {
  const Error error = error_of(content, name);
  EXPECT_EQ(error.code(), code) << error.what();
  EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
}

TEST(Obj, IndicesOfEverySpelling) {
  const Scan scan = read(kFourV +
                         "vt 0 0\nvn 0 0 1\nf 1 2 3\nf 1/1 2/1 4/1\nf 1//1 3//1 4//1\nf 2/1/1 3/1/1 4/1/1\nf "
                         "-4 -3 -2\nf 1/ 2/ 3/\n");
  EXPECT_EQ(scan.format, ScanFormat::obj);
  expect_vertices(scan, kFour);
  expect_faces(scan, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2}, {0, 1, 2}});
}

TEST(Obj, PolygonsContinuationsCommentsAndWindowsLineEnds) {
  const Scan scan = read(
      "# made by hand\r\nmtllib some.mtl\r\no Körper\r\n\r\nv 0 0 \\\r\n 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 0 0 "
      "1\r\n"
      "s off\r\nf 1 2 \\\r\n3 4\r\nl 1 2\r\nf 1 2 3 # the last\r\n");
  expect_vertices(scan, kFour);
  expect_faces(scan, {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}});
}

TEST(Obj, VertexColoursAndByteOrderMark) {
  const Scan scan =
      read("\xef\xbb\xbfv 0 0 0 1 0 0.5\nv 1 0 0 0 1 0\nv 0 1 0 0 0 0\nv 0 0 1 1.0 1.0 1.0\nf 1 2 3\n");
  EXPECT_EQ(scan.colours, (std::vector<std::uint8_t>{255, 0, 128, 0, 255, 0, 0, 0, 0, 255, 255, 255}));
  const Scan partly = read("v 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0 0 0 0\nv 0 0 1 1.0 1.0 1.0\n");
  EXPECT_TRUE(partly.colours.empty());
  EXPECT_EQ(partly.notes.size(), 1u);
}

TEST(Obj, NormalsAreTakenOnlyWhereTheyBelongToVertices) {
  const std::string normals = "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn 0 0 -1\n";
  EXPECT_EQ(read(kFourV + normals + "f 1//1 2//2 4//4\n").normals.col(3), Vec3f(0, 0, -1));
  EXPECT_EQ(read(kFourV + normals + "f 1//1 2//2 4//3\n").normals.cols(), 0);
  EXPECT_EQ(read(kFourV + "vn 0 0 1\nf 1//1 2//1 4//1\n").normals.cols(), 0);
}

TEST(Obj, FacesMayComeBeforeTheirVertices) { expect_faces(read("f 1 2 3\n" + kFourV), {{0, 1, 2}}); }

TEST(Obj, Errors) {
  expect_error(kFourV + "f 1 2 5\n", "a.obj", ErrorCode::bad_file, "line 5");
  expect_error(kFourV + "\nf 0 1 2\n", "a.obj", ErrorCode::bad_file, "line 6");
  expect_error(kFourV + "f 1 2 -5\n", "a.obj", ErrorCode::bad_file, "-5");
  expect_error(kFourV + "f 1 2 x\n", "a.obj", ErrorCode::bad_file, "line 5");
  expect_error(kFourV + "f 1 2 3.5\n", "a.obj", ErrorCode::bad_file, "line 5");
  expect_error(kFourV + "v 1 2\n", "a.obj", ErrorCode::bad_file, "line 5");
  expect_error("v 0 0 0\nv 1 0 0\n", "a.obj", ErrorCode::no_geometry, "four distinct");
}

TEST(Stl, AsciiOfSeveralSolidsAndCapitals) {
  const Scan scan = read(
      "solid a\nFACET NORMAL 0 0 1\n OUTER LOOP\n  VERTEX 0 0 0\n  VERTEX 1e0 0 0\n  VERTEX 0 +1 0\n "
      "ENDLOOP\nENDFACET\nendsolid a\n"
      "solid b\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 "
      "-1.5\nendloop\nendfacet\nendsolid\n");
  EXPECT_EQ(scan.format, ScanFormat::stl);
  expect_vertices(scan, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, -1.5}});
  expect_faces(scan, {{0, 1, 2}, {3, 4, 5}});
}

TEST(Stl, BinaryThatBeginsWithSolidOrNot) {
  const Solid solid;
  std::vector<std::array<double, 3>> expected;
  for (const auto& face : solid.faces) {
    for (const int corner : face) expected.push_back(solid.vertices[corner]);
  }
  for (const char* header : {"solid exported", "made by hand", ""}) {
    const Scan scan = read(binary_stl(header), "a.stl");
    EXPECT_EQ(scan.format, ScanFormat::stl);
    expect_vertices(scan, expected);
    EXPECT_EQ(scan.faces.cols(), 12);
    EXPECT_EQ(scan.faces.col(11), Eigen::Vector3i(33, 34, 35));
  }
  const Scan longer = read(binary_stl("made by hand") + "tail", "a.stl");
  EXPECT_EQ(longer.faces.cols(), 12);
  EXPECT_EQ(longer.notes.size(), 1u);
}

TEST(Stl, Errors) {
  const std::string good = binary_stl("made by hand");
  expect_error(good.substr(0, good.size() - 1), "a.stl", ErrorCode::bad_file, "announces 12 facets");
  expect_error(good.substr(0, 70), "a.stl", ErrorCode::bad_file, "too short");
  std::string huge = good;
  std::memset(huge.data() + 80, 0xff, 4);
  expect_error(huge, "a.stl", ErrorCode::bad_file, "4294967295");
  expect_error("solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n", "a.stl",
               ErrorCode::bad_file, "fewer than three");
  expect_error(
      "solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n",
      "a.stl", ErrorCode::bad_file, "line 7");
  expect_error("solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 x\n", "a.stl", ErrorCode::bad_file,
               "line 5");
  expect_error("solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 1\n", "a.stl", ErrorCode::bad_file,
               "cut short");
  expect_error("solid a\nendsolid a\n", "a.stl", ErrorCode::no_geometry, "no vertices");
}

TEST(Off, Variants) {
  const std::string body = "0 0 0\n1 0 0 # comment\n\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 2 3 255 0 0\n";
  const std::vector<std::array<int, 3>> faces = {{0, 1, 2}, {0, 1, 2}, {0, 2, 3}};
  for (const std::string& head : {std::string("OFF\n4 2 0\n"), std::string("OFF 4 2 0\n"),
                                  std::string("# hand\nOFF # x\n# y\n4 2\n")}) {
    const Scan scan = read(head + body);
    EXPECT_EQ(scan.format, ScanFormat::off);
    expect_vertices(scan, kFour);
    expect_faces(scan, faces);
    EXPECT_TRUE(scan.colours.empty());
  }
}

TEST(Off, ColoursAndNormals) {
  const Scan coloured =
      read("COFF\n4 0 0\n0 0 0 255 0 1 255\n1 0 0 0 255 0 255\n0 1 0 1 2 3 255\n0 0 1 9 9 9 255\n");
  EXPECT_EQ(coloured.colours, (std::vector<std::uint8_t>{255, 0, 1, 0, 255, 0, 1, 2, 3, 9, 9, 9}));
  const Scan both = read(
      "CNOFF\n4 0 0\n0 0 0 0 0 1 1 0 0 1\n1 0 0 0 0 1 0 1 0 1\n0 1 0 0 0 1 0 0 1 1\n0 0 1 0 1 0 0 0 0 1\n");
  EXPECT_EQ(both.normals.col(3), Vec3f(0, 1, 0));
  EXPECT_EQ(both.colours[0], 255);
}

TEST(Off, Errors) {
  expect_error("OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 4\n", "a.off", ErrorCode::bad_file, "vertex 4");
  expect_error("OFF\n4 1 0\n0 0 0\n1 0\n0 1 0\n0 0 1\n3 0 1 2\n", "a.off", ErrorCode::bad_file, "line 4");
  expect_error("OFF\n4000000000 1 0\n0 0 0\n", "a.off", ErrorCode::bad_file, "more than the file can hold");
  expect_error("OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1\n", "a.off", ErrorCode::bad_file,
               "3 vertex indices");
  expect_error("OFF BINARY\n4 1 0\n", "a.off", ErrorCode::unsupported_format, "binary");
  expect_error("4OFF\n4 1 0\n", "a.off", ErrorCode::unsupported_format, "four");
}

TEST(Xyz, SeparatorsCommentsHeadersAndCounts) {
  const std::string variants[] = {
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
      "0,0,0\n1,0,0\n0,1,0\n0,0,1",
      "0, 0, 0\n1, 0, 0\n0, 1, 0\n0, 0, 1\n",
      "0;0;0\r\n1;0;0\r\n0;1;0\r\n0;0;1\r\n",
      "# comment\n// another\n0\t0\t0\n\n1\t0\t0\n0\t1\t0\n0\t0\t1\n",
      "X Y Z\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
      "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n",
      "4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
      "0,00 0,00 0,00\n1,00 0,00 0,00\n0,00 1,00 0,00\n0,00 0,00 1,00\n",
      "0,00; 0,00; 0,00\n1,00; 0,00; 0,00\n0,00; 1,00; 0,00\n0,00; 0,00; 1,00\n",
      "0 0 0\r1 0 0\r0 1 0\r0 0 1\r",
  };
  for (const std::string& content : variants) {
    const Scan scan = read(content, "a.xyz");
    EXPECT_EQ(scan.format, ScanFormat::xyz) << content;
    expect_vertices(scan, kFour);
    EXPECT_TRUE(scan.colours.empty()) << content;
    EXPECT_EQ(scan.normals.cols(), 0) << content;
  }
}

TEST(Xyz, ColumnsBehindTheCoordinates) {
  EXPECT_EQ(read("0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n0 0 1 255 0 0\n").colours,
            (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 255, 0, 0}));
  const Scan pts = read("4\n0 0 0 -1200 1 2 3\n1 0 0 -700 4 5 6\n0 1 0 3 7 8 9\n0 0 1 9 255 0 0\n", "a.pts");
  EXPECT_EQ(pts.colours, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 255, 0, 0}));
  EXPECT_EQ(read("0 0 0 0.6 0.8 0\n1 0 0 0 0 1\n0 1 0 0 1 0\n0 0 1 1 0 0\n").normals.col(0),
            Vec3f(0.6f, 0.8f, 0));
  const Scan both =
      read("0 0 0 0.6 0.8 0 10 20 30\n1 0 0 0 0 1 1 1 1\n0 1 0 0 1 0 2 2 2\n0 0 1 1 0 0 3 3 3\n");
  EXPECT_EQ(both.colours[2], 30);
  EXPECT_EQ(both.normals.col(2), Vec3f(0, 1, 0));
  EXPECT_TRUE(read("0 0 0 0.125\n1 0 0 0.25\n0 1 0 0.5\n0 0 1 0\n").colours.empty());
}

TEST(Xyz, Errors) {
  expect_error("0 0 0\n1 0 0\n0 one 0\n0 0 1\n", "a.xyz", ErrorCode::bad_file, "line 3");
  expect_error("0 0 0\n1 0 0\n0 1 0\n0 1\n", "a.xyz", ErrorCode::bad_file, "line 4");
  expect_error("0 0 0\n1 0 0\n1 1 1\n", "a.xyz", ErrorCode::no_geometry, "four distinct");
}

TEST(Pcd, BinaryWithFieldsOfOtherSizes) {
  const Scan scan = read(binary_pcd());
  const Solid solid;
  EXPECT_EQ(scan.format, ScanFormat::pcd);
  expect_vertices(scan, solid.vertices);
  expect_colours(scan, solid);
  EXPECT_EQ(scan.normals.col(5), Vec3f(0, 1, 0));
}

TEST(Pcd, CompressedLeavesMissingMeasurementsOut) {
  const Scan scan = read(fixture("compressed.pcd"));
  const std::string npy = fixture("compressed_points.npy");
  ASSERT_EQ(scan.vertices.cols(), 299);
  const float* points = reinterpret_cast<const float*>(npy.data() + npy.size() - 300 * 12);
  for (int i = 0, k = 0; i < 300; ++i) {
    if (i == 7) continue;
    for (int axis = 0; axis < 3; ++axis) {
      float expected;
      std::memcpy(&expected, points + 3 * i + axis, 4);
      EXPECT_EQ(scan.origin[axis] + scan.vertices(axis, k), expected);
    }
    EXPECT_EQ(scan.colours[3 * k], i % 256);
    EXPECT_EQ(scan.colours[3 * k + 1], 128);
    ++k;
  }
  EXPECT_EQ(scan.notes.size(), 1u);
}

TEST(Pcd, AsciiWithFloatColour) {
  // 4.2108e+06 is PCL's way to write the integer 0x404080 as the bits of a float.
  float colour;
  const std::uint32_t bits = 0x00102030;
  std::memcpy(&colour, &bits, 4);
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(colour));
  const std::string rgb = std::string(" ") + text + "\n";
  const Scan scan = read(
      "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F "
      "F\nCOUNT 1 1 1 1\n"
      "WIDTH 4\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA ascii\n0 0 0" +
      rgb + "1 0 0" + rgb + "0 1 0" + rgb + "0 0 1" + rgb);
  expect_vertices(scan, kFour);
  EXPECT_EQ(scan.colours[0], 0x10);
  EXPECT_EQ(scan.colours[10], 0x20);
}

TEST(Pcd, Errors) {
  const std::string head = "# .PCD v.7\nVERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  expect_error(head + "WIDTH 4\nHEIGHT 1\nPOINTS 4\nDATA ascii\n0 0 0\n1 0 0\n0 1 0\n0 x 1\n", "a.pcd",
               ErrorCode::bad_file, "point 3");
  expect_error(head + "WIDTH 4\nHEIGHT 1\nPOINTS 400000000000\nDATA binary\nxxxx", "a.pcd",
               ErrorCode::bad_file, "400000000000");
  expect_error(head + "WIDTH 4\nHEIGHT 1\nPOINTS 4\nDATA binary\nxxxx", "a.pcd", ErrorCode::bad_file,
               "cut short");
  expect_error(head + "WIDTH 4\nHEIGHT 1\nPOINTS 0\nDATA ascii\n", "a.pcd", ErrorCode::no_geometry,
               "no points");
  expect_error(head + "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\nnan nan nan\nnan nan nan\n", "a.pcd",
               ErrorCode::no_geometry, "no measured");
  expect_error(head + "SIZE 4 4\nDATA ascii\n", "a.pcd", ErrorCode::bad_file, "does not match FIELDS");
  expect_error("# .PCD v.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nPOINTS 1\nDATA ascii\n0 0\n", "a.pcd",
               ErrorCode::bad_file, "x, y and z");
  expect_error("# .PCD v.7\nFIELDS x y z\n", "a.pcd", ErrorCode::bad_file, "DATA");
}

}  // namespace
}  // namespace vitruvian::test
