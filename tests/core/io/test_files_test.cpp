#include "core/io/test_files.h"

#include "io/mesh_writer.h"

namespace vitruvian::test {

std::string binary_ply(bool big_endian) {
  const Solid solid;
  std::string out =
      std::string("ply\r\nformat binary_") + (big_endian ? "big" : "little") +
      "_endian 1.0\r\ncomment made by hand\r\nelement camera 2\r\nproperty short id\r\n"
      "property list uchar double matrix\r\nelement vertex 8\r\nproperty uchar red\r\nproperty double y\r\n"
      "property float x\r\nproperty uchar green\r\nproperty ushort quality\r\nproperty int z\r\nproperty "
      "uchar blue\r\n"
      "element face 12\r\nproperty list ushort float texcoord\r\nproperty list uint short vertex_indices\r\n"
      "property uchar flags\r\nend_header\r\n";
  for (int camera = 0; camera < 2; ++camera) {
    put(out, std::int16_t{3}, big_endian);
    put(out, static_cast<std::uint8_t>(camera * 3));
    for (int k = 0; k < camera * 3; ++k) put(out, 1.5, big_endian);
  }
  for (std::size_t v = 0; v < 8; ++v) {
    put(out, static_cast<std::uint8_t>(solid.colour(v)[0]));
    put(out, solid.vertices[v][1], big_endian);
    put(out, static_cast<float>(solid.vertices[v][0]), big_endian);
    put(out, static_cast<std::uint8_t>(solid.colour(v)[1]));
    put(out, std::uint16_t{4}, big_endian);
    put(out, static_cast<std::int32_t>(8 * solid.vertices[v][2]), big_endian);
    put(out, static_cast<std::uint8_t>(solid.colour(v)[2]));
  }
  for (const auto& face : solid.faces) {
    put(out, std::uint16_t{2}, big_endian);
    put(out, 0.5f, big_endian);
    put(out, 0.25f, big_endian);
    put(out, std::uint32_t{3}, big_endian);
    for (const int corner : face) put(out, static_cast<std::int16_t>(corner), big_endian);
    put(out, std::uint8_t{1});
  }
  return out;
}

std::string glb(const std::string& json, const std::string& binary) {
  std::string padded_json = json, padded_binary = binary;
  padded_json.resize((json.size() + 3) / 4 * 4, ' ');
  padded_binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string out = "glTF";
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(12 + 8 + padded_json.size() + 8 + padded_binary.size()));
  put(out, static_cast<std::uint32_t>(padded_json.size()));
  out += "JSON" + padded_json;
  put(out, static_cast<std::uint32_t>(padded_binary.size()));
  out += std::string("BIN\0", 4) + padded_binary;
  return out;
}

std::string solid_glb() {
  const Solid solid;
  std::string binary;
  for (const auto& vertex : solid.vertices) {
    for (const double coordinate : vertex) put(binary, static_cast<float>(coordinate));
  }
  for (std::size_t v = 0; v < 8; ++v) {
    for (const float component : {0.0f, 0.0f, 1.0f}) put(binary, component);
  }
  for (std::size_t v = 0; v < 8; ++v) {
    for (const int channel : solid.colour(v)) put(binary, static_cast<std::uint8_t>(channel));
    put(binary, std::uint8_t{255});
  }
  for (const auto& face : solid.faces) {
    for (const int corner : face) put(binary, static_cast<std::uint16_t>(corner));
  }
  return glb(
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,10]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":2},"indices":3}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":8,"type":"VEC3"},
{"bufferView":2,"componentType":5121,"normalized":true,"count":8,"type":"VEC4"},{"bufferView":3,"componentType":5123,"count":36,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":96},{"buffer":0,"byteOffset":192,"byteLength":32},
{"buffer":0,"byteOffset":224,"byteLength":72}],"buffers":[{"byteLength":296}]})",
      binary);
}

std::string binary_stl(const std::string& header) {
  const Solid solid;
  std::string out = header;
  out.resize(80, ' ');
  put(out, std::uint32_t{12});
  for (const auto& face : solid.faces) {
    for (int k = 0; k < 3; ++k) put(out, 0.0f);
    for (const int corner : face) {
      for (const double coordinate : solid.vertices[corner]) put(out, static_cast<float>(coordinate));
    }
    put(out, std::uint16_t{0});
  }
  return out;
}

std::string binary_pcd() {
  const Solid solid;
  std::string out =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ rgb normal_x normal_y normal_z\nSIZE 8 4 4 1 4 4 4 4\nTYPE F "
      "F F U U F F F\n"
      "COUNT 1 1 1 3 1 1 1 1\nWIDTH 4\nHEIGHT 2\nPOINTS 8\nDATA binary\n";
  for (std::size_t v = 0; v < 8; ++v) {
    put(out, solid.vertices[v][0]);
    put(out, static_cast<float>(solid.vertices[v][1]));
    put(out, static_cast<float>(solid.vertices[v][2]));
    out += "abc";
    const auto colour = solid.colour(v);
    put(out, static_cast<std::uint32_t>(colour[0] << 16 | colour[1] << 8 | colour[2]));
    for (const float component : {0.0f, 1.0f, 0.0f}) put(out, component);
  }
  return out;
}

std::vector<NamedContent> one_of_every_format() {
  const Solid solid;
  std::string ascii_ply =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nelement face 12\nproperty list uchar int "
      "vertex_index\nend_header\n";
  std::string obj = "# by hand\nmtllib a.mtl\no body\n", off = "COFF\n8 12 0\n", xyz, pts = "8\n";
  std::string stl = "solid body\n", pcd =
                                        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 "
                                        "1\nWIDTH 8\nHEIGHT 1\nPOINTS 8\nDATA ascii\n";
  for (std::size_t v = 0; v < 8; ++v) {
    const auto& p = solid.vertices[v];
    const auto colour = solid.colour(v);
    std::string position, rgb;
    for (const double coordinate : p) position += std::to_string(coordinate) + " ";
    for (const int channel : colour) rgb += std::to_string(channel) + " ";
    ascii_ply += position + rgb + "\n";
    obj += "v " + position + "\n";
    off += position + rgb + "255\n";
    xyz += position + rgb + "\n";
    pts += position + "-120 " + rgb + "\n";
    pcd += position + "\n";
  }
  for (const auto& face : solid.faces) {
    const std::string corners =
        std::to_string(face[0]) + " " + std::to_string(face[1]) + " " + std::to_string(face[2]);
    ascii_ply += "3 " + corners + "\n";
    off += "3 " + corners + "\n";
    obj += "f";
    stl += "facet normal 0 0 1\nouter loop\n";
    for (const int corner : face) {
      obj += " " + std::to_string(corner + 1) + "/" + std::to_string(corner + 1);
      stl += "vertex";
      for (const double coordinate : solid.vertices[corner]) stl += " " + std::to_string(coordinate);
      stl += "\n";
    }
    obj += "\n";
    stl += "endloop\nendfacet\n";
  }
  stl += "endsolid body\n";
  return {
      {"ascii.ply", ascii_ply},
      {"little.ply", binary_ply(false)},
      {"big.ply", binary_ply(true)},
      {"body.obj", obj},
      {"ascii.stl", stl},
      {"binary.stl", binary_stl()},
      {"body.off", off},
      {"body.glb", solid_glb()},
      {"body.gltf",
       R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5121,"count":6,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":18}],
"buffers":[{"byteLength":18,"uri":"data:application/octet-stream;base64,AAAABAAAAAQAAAAEBAAEAAQE"}]})"},
      {"body.xyz", xyz},
      {"body.pts", pts},
      {"ascii.pcd", pcd},
      {"binary.pcd", binary_pcd()},
      {"compressed.pcd", fixture("compressed.pcd")}};
}

TEST(TestFiles, AllAreSound) {
  for (const NamedContent& file : one_of_every_format()) {
    const Scan scan = read(file.content, file.name);
    EXPECT_GE(scan.vertices.cols(), 6) << file.name;
    EXPECT_EQ(scan.file_name, file.name);
    EXPECT_EQ(scan.sha256.size(), 64u);
  }
}

}  // namespace vitruvian::test
