#include "base/sha256.h"
#include "core/io/test_files.h"

namespace vitruvian::test {
namespace {

/// gzip of stored deflate blocks, with a correct trailer.
std::string gzipped(const std::string& content, std::uint32_t crc) {
  std::string out("\x1f\x8b\x08\0\0\0\0\0\0\3", 10);
  for (std::size_t begin = 0;; begin += 65535) {
    const std::string block = content.substr(begin, 65535);
    const bool last = begin + 65535 >= content.size();
    out += static_cast<char>(last);
    put(out, static_cast<std::uint16_t>(block.size()));
    put(out, static_cast<std::uint16_t>(~block.size()));
    out += block;
    if (last) break;
  }
  put(out, crc);
  put(out, static_cast<std::uint32_t>(content.size()));
  return out;
}

std::uint32_t slow_crc(const std::string& content) {
  std::uint32_t crc = ~0u;
  for (const char c : content) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  return ~crc;
}

TEST(Detect, ContentDecidesAndNotTheName) {
  for (const NamedContent& file : one_of_every_format()) {
    const ScanFormat expected = read(file.content, file.name).format;
    for (const char* name : {"scan", "scan.dat", "scan.ply", "scan.xyz", "scan.glb", "人体 scan.PLY"}) {
      EXPECT_EQ(read(file.content, name).format, expected) << file.name << " as " << name;
    }
  }
}

TEST(Detect, EveryFormatGzippedGivesTheSameAndTheHashOfThePackedFile) {
  for (const NamedContent& file : one_of_every_format()) {
    const std::string packed = gzipped(file.content, slow_crc(file.content));
    const Scan plain = read(file.content, file.name);
    const Scan scan = read(packed, file.name + ".gz");
    EXPECT_EQ(scan.format, plain.format) << file.name;
    EXPECT_TRUE(scan.vertices == plain.vertices) << file.name;
    EXPECT_TRUE(scan.faces == plain.faces) << file.name;
    EXPECT_EQ(scan.sha256, to_hex(sha256(as_bytes(packed)))) << file.name;
    EXPECT_EQ(scan.file_name, file.name + ".gz");
    EXPECT_EQ(error_of(packed.substr(0, packed.size() - 1)).code(), ErrorCode::bad_file);
  }
}

TEST(Detect, ThreadsDoNotChangeTheResult) {
  const std::string content = binary_ply(false);
  const Scan one = read_scan(as_bytes(content), "a.ply", Execution(1)),
             four = read_scan(as_bytes(content), "a.ply", Execution(4));
  EXPECT_TRUE(one.vertices == four.vertices);
  EXPECT_EQ(one.sha256, four.sha256);
  EXPECT_EQ(one.sha256, to_hex(sha256(as_bytes(content))));
}

TEST(Detect, HelpfulRefusals) {
  const auto expect = [](const std::string& content, const std::string& name, ErrorCode code,
                         const std::string& part) {
    const Error error = error_of(content, name);
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind(name + ": ", 0), 0u) << error.what();
  };
  expect("", "leer.ply", ErrorCode::bad_file, "empty");
  expect("Dear Sir,\nplease find the scan attached.\n", "letter.txt", ErrorCode::unsupported_format,
         "text, but not a scan");
  expect("Dear Sir,\nplease find the scan attached.\n", "letter.ply", ErrorCode::bad_file, "named .ply");
  expect(std::string("PK\x03\x04zzzz", 8), "scan.zip", ErrorCode::unsupported_format, "unpack it");
  expect("\x89PNG\r\n\x1a\n", "photo.png", ErrorCode::unsupported_format, "PNG image");
  expect("\xff\xd8\xff\xe0....", "photo.obj", ErrorCode::unsupported_format, "JPEG image");
  expect("Kaydara FBX Binary  ", "a.fbx", ErrorCode::unsupported_format, "FBX");
  expect("<?xml version=\"1.0\"?><COLLADA>", "a.dae", ErrorCode::unsupported_format, "COLLADA");
  expect("{\"frame\": \"scan\"}", "a.json", ErrorCode::unsupported_format, "not glTF");
  expect(std::string("\xff\xfev\0 \0", 6), "a.obj", ErrorCode::unsupported_format, "UTF-16");
  expect(std::string("\0\1\2\3\4\5\6\7", 8), "a.bin", ErrorCode::unsupported_format, "not known");
  const std::string plain = "v 0 0 0\n";
  const std::string twice =
      gzipped(gzipped(plain, slow_crc(plain)), slow_crc(gzipped(plain, slow_crc(plain))));
  expect(twice, "a.obj.gz", ErrorCode::unsupported_format, "twice");
}

}  // namespace
}  // namespace vitruvian::test
