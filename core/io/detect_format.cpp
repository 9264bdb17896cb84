#include <string>
#include <string_view>

#include "base/error.h"
#include "base/inflate.h"
#include "io/readers.h"
#include "io/text_cursor.h"

namespace vitruvian {
namespace {

constexpr const char* kReadable = "use PLY, OBJ, STL, OFF, GLB, glTF with embedded data, XYZ or PCD";

struct KnownKind {
  std::string_view magic;
  std::size_t offset;
  const char* is;
  const char* mend;  ///< null: the list of formats that are read
};

using namespace std::string_view_literals;

/// Kinds of files that people give by mistake.
constexpr KnownKind kKnownKinds[] = {
    {"PK\x03\x04"sv, 0, "a zip archive (or 3MF, DOCX, NPZ ...)", "unpack it and give the scan inside"},
    {"\x1f\x8b"sv, 0, "gzipped twice", "unpack it once"},
    {"7z\xbc\xaf\x27\x1c"sv, 0, "a 7-Zip archive", "unpack it and give the scan inside"},
    {"Rar!"sv, 0, "a RAR archive", "unpack it and give the scan inside"},
    {"BZh"sv, 0, "compressed with bzip2", "unpack it first, or use gzip"},
    {"\xfd"
     "7zXZ\0"sv,
     0, "compressed with xz", "unpack it first, or use gzip"},
    {"\x28\xb5\x2f\xfd"sv, 0, "compressed with Zstandard", "unpack it first, or use gzip"},
    {"ustar"sv, 257, "a tar archive", "unpack it and give the scan inside"},
    {"\x89PNG"sv, 0, "a PNG image", "a 3D scan is needed, not a picture of one"},
    {"\xff\xd8\xff"sv, 0, "a JPEG image", "a 3D scan is needed, not a picture of one"},
    {"GIF8"sv, 0, "a GIF image", "a 3D scan is needed, not a picture of one"},
    {"BM"sv, 0, "a BMP image", "a 3D scan is needed, not a picture of one"},
    {"RIFF"sv, 0, "a RIFF file (picture, sound or film)", "a 3D scan is needed"},
    {"ftyp"sv, 4, "a film or HEIC picture", "a 3D scan is needed"},
    {"%PDF"sv, 0, "a PDF document", "a 3D scan is needed"},
    {"Kaydara FBX"sv, 0, "an FBX file", nullptr},
    {"BLENDER"sv, 0, "a Blender file", "export the scan from Blender as PLY or GLB"},
    {"LASF"sv, 0, "a LAS point cloud", nullptr},
    {"ASTM-E57"sv, 0, "an E57 point cloud", nullptr},
    {"DRACO"sv, 0, "a Draco file", nullptr},
    {"# vtk DataFile"sv, 0, "a VTK file", nullptr},
    {"<?xml"sv, 0, "an XML file (COLLADA, X3D, VTU ...)", nullptr},
    {"#VRML"sv, 0, "a VRML file", nullptr},
    {"\x89HDF"sv, 0, "an HDF5 file", nullptr},
    {"\x93NUMPY"sv, 0, "a NumPy array", nullptr},
    {"\xff\xfe"sv, 0, "text in UTF-16", "save it as plain text (UTF-8)"},
    {"\xfe\xff"sv, 0, "text in UTF-16", "save it as plain text (UTF-8)"},
};

std::string extension_of(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? "" : lower_case(name.substr(dot + 1));
}

bool is_off_header(std::string_view word) {
  for (const std::string_view flag : {"ST"sv, "C"sv, "N"sv, "4"sv, "n"sv}) {
    if (word.substr(0, flag.size()) == flag) word.remove_prefix(flag.size());
  }
  return word == "OFF";
}

bool is_number(std::string_view word) {
  while (!word.empty() && (word.back() == ',' || word.back() == ';')) word.remove_suffix(1);
  TextCursor inside(word);
  return !word.empty() && word.find_first_of("0123456789") != std::string_view::npos &&
         word.find_first_not_of("0123456789+-.,;eE") == std::string_view::npos;
}

enum class TextKind { obj, cloud, unknown };

/// Tells OBJ statements and lines of numbers from prose, by the first lines.
TextKind kind_of_text(TextCursor cursor) {
  std::size_t numeric = 0, other = 0;
  for (int n = 0; n < 2000 && !cursor.at_end(); ++n) {
    const std::string_view line = cursor.take_line();
    if (line.empty() || line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//") continue;
    TextCursor words(line);
    const std::string_view first = words.take_word();
    if (is_number(first)) {
      ++numeric;
      if (numeric >= 3) return TextKind::cloud;
      continue;
    }
    if ((first == "v" || first == "vn" || first == "f") && (is_number(words.take_word()) || first == "f"))
      return TextKind::obj;
    // A cloud may begin with a line of column names.
    if (++other > 1 && numeric > 0) return TextKind::unknown;
  }
  return numeric > 0 && other <= 1 ? TextKind::cloud : TextKind::unknown;
}

[[noreturn]] void unsupported(const std::string& what, const char* mend) {
  throw Error(ErrorCode::unsupported_format, what + ": " + (mend ? mend : kReadable));
}

}  // namespace

ScanFormat detect_format(std::span<const std::byte> bytes, std::string_view stem_name) {
  if (bytes.empty()) throw Error(ErrorCode::bad_file, "the file is empty: copy or export it again");
  const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string extension = extension_of(stem_name);
  if (content.substr(0, 4) == "glTF") return ScanFormat::glb;
  if (content.substr(0, 3) == "ply" && content.size() > 3 &&
      (content[3] == '\n' || content[3] == '\r' || content[3] == ' ')) {
    return ScanFormat::ply;
  }
  if (is_sized_like_binary_stl(bytes)) return ScanFormat::stl;
  for (const KnownKind& kind : kKnownKinds) {
    if (content.size() > kind.offset && content.substr(kind.offset, kind.magic.size()) == kind.magic) {
      // Short magics occur by chance in binary STL, whose first bytes are free text.
      if (extension == "stl" && kind.magic.size() < 3) continue;
      unsupported(std::string("this is ") + kind.is, kind.mend);
    }
  }

  const bool is_text = content.substr(0, 4096).find('\0') == std::string_view::npos;
  TextCursor cursor(bytes);
  cursor.skip_space();
  if (content.substr(cursor.offset(), 7) == "# .PCD " || extension == "pcd") return ScanFormat::pcd;
  const TextCursor first_content = cursor;
  std::string_view word = cursor.take_word();
  while (!word.empty() && word[0] == '#' && !cursor.at_end()) {
    cursor.skip_line();
    cursor.skip_space();
    word = cursor.take_word();
  }
  if (is_off_header(word)) return ScanFormat::off;
  if (is_text && word == "VERSION" && content.find("FIELDS") != std::string_view::npos)
    return ScanFormat::pcd;
  if (is_text && !word.empty() && word[0] == '{') {
    if (content.find("\"asset\"") != std::string_view::npos || extension == "gltf") return ScanFormat::gltf;
    unsupported("this is JSON, but not glTF", nullptr);
  }
  const std::string lower_word = lower_case(word.substr(0, 16));
  if (lower_word == "solid" && (extension == "stl" || content.find("facet") != std::string_view::npos))
    return ScanFormat::stl;
  if (extension == "stl") return ScanFormat::stl;
  if (is_text) {
    const TextKind kind = kind_of_text(first_content);
    if (kind == TextKind::obj || (kind == TextKind::unknown && extension == "obj")) return ScanFormat::obj;
    if (kind == TextKind::cloud) return ScanFormat::xyz;
  }
  if (extension == "ply" || extension == "glb" || extension == "gltf" || extension == "off") {
    throw Error(ErrorCode::bad_file,
                "named ." + extension + ", but it does not begin like such a file: export it again");
  }
  unsupported(is_text ? "this is text, but not a scan" : "the kind of this file is not known", nullptr);
}

}  // namespace vitruvian
