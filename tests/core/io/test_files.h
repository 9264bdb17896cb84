#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/execution.h"
#include "io/scan.h"

namespace vitruvian::test {

inline std::span<const std::byte> as_bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

inline Scan read(const std::string& content, const std::string& name = "scan") {
  return read_scan(as_bytes(content), name, Execution(1));
}

/// The error that reading gives; fails the test when there is none.
inline Error error_of(const std::string& content, const std::string& name = "scan") {
  try {
    read(content, name);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error from " << name;
  return Error(ErrorCode::internal, "no error");
}

inline std::string fixture(const std::string& name) {
  std::ifstream file(std::string(VITRUVIAN_SOURCE_DIR) + "/tests/fixtures/io/" + name, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_FALSE(text.empty()) << name;
  return text;
}

/// Appends a number's bytes.
template <class T>
void put(std::string& out, T value, bool big_endian = false) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof raw);
  out.append(raw, sizeof raw);
}

/// A small solid: a cube with a top, eight vertices and twelve triangles, coordinates exact in float.
struct Solid {
  std::vector<std::array<double, 3>> vertices = {{0, 0, 0}, {2, 0, 0},    {2, 1, 0},     {0, 1, 0},
                                                 {0, 0, 4}, {2, 0, 4.25}, {2, 1, 4.125}, {0, 1, -3.5}};
  std::vector<std::array<int, 3>> faces = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                           {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  std::array<int, 3> colour(std::size_t v) const {
    return {static_cast<int>(v) * 30, 255 - static_cast<int>(v), 7};
  }
};

inline void expect_vertices(const Scan& scan, const std::vector<std::array<double, 3>>& expected) {
  ASSERT_EQ(scan.vertices.cols(), static_cast<Index>(expected.size()));
  for (std::size_t v = 0; v < expected.size(); ++v) {
    const Vec3d found = scan.origin + scan.vertices.col(static_cast<Index>(v)).cast<double>();
    for (int axis = 0; axis < 3; ++axis) EXPECT_DOUBLE_EQ(found[axis], expected[v][axis]) << "vertex " << v;
  }
}

inline void expect_faces(const Scan& scan, const std::vector<std::array<int, 3>>& expected) {
  ASSERT_EQ(scan.faces.cols(), static_cast<Index>(expected.size()));
  for (std::size_t f = 0; f < expected.size(); ++f) {
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(scan.faces(k, static_cast<Index>(f)), expected[f][k]) << "face " << f;
  }
}

inline void expect_colours(const Scan& scan, const Solid& solid) {
  ASSERT_EQ(scan.colours.size(), 3 * solid.vertices.size());
  for (std::size_t v = 0; v < solid.vertices.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(scan.colours[3 * v + c], solid.colour(v)[c]) << "vertex " << v;
  }
}

inline void expect_solid(const Scan& scan) {
  const Solid solid;
  expect_vertices(scan, solid.vertices);
  expect_faces(scan, solid.faces);
}

/// One small sound file of every format, for truncation and mutation; names carry the extension.
struct NamedContent {
  std::string name, content;
};
std::vector<NamedContent> one_of_every_format();

std::string binary_ply(bool big_endian);
std::string glb(const std::string& json, const std::string& binary);
/// GLB of the solid: positions, normals, colours, u16 indices; one node with a translation.
std::string solid_glb();
std::string binary_stl(const std::string& header = "solid but binary");
std::string binary_pcd();

}  // namespace vitruvian::test
