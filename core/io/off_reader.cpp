#include <string>
#include <vector>

#include "io/readers.h"
#include "io/scan_builder.h"
#include "io/text_cursor.h"

namespace vitruvian {
namespace {

[[noreturn]] void fail(const TextCursor& cursor, const std::string& what) {
  throw Error(ErrorCode::bad_file, cursor.describe(what));
}

/// Skips blank lines and comments, in front of a line with content.
void go_to_content(TextCursor& cursor) {
  for (;;) {
    cursor.skip_space();
    if (cursor.peek() != '#') return;
    cursor.skip_line();
  }
}

std::size_t take_count(TextCursor& cursor, const std::string& of_what) {
  go_to_content(cursor);
  const auto count = cursor.take_integer();
  if (!count || *count < 0) fail(cursor, "the number of " + of_what + " is missing");
  // Every vertex and face takes at least two characters.
  if (static_cast<std::uint64_t>(*count) > cursor.remaining() / 2 + 1) {
    fail(cursor, "announces " + std::to_string(*count) + " " + of_what + ", more than the file can hold");
  }
  return static_cast<std::size_t>(*count);
}

}  // namespace

Scan read_off(std::span<const std::byte> bytes, const Execution& execution) {
  TextCursor cursor(bytes);
  go_to_content(cursor);
  std::string word(cursor.take_word());
  bool has_normals = false;
  const std::string flags = word.substr(0, word.find("OFF"));
  for (const char flag : flags) {
    if (flag == 'N') has_normals = true;
    if (flag == '4' || flag == 'n') {
      throw Error(ErrorCode::unsupported_format,
                  "line 1: OFF with four or n coordinates is not read: export plain OFF or PLY");
    }
  }
  const TextCursor after_word = cursor;
  if (cursor.take_word() == "BINARY") {
    throw Error(ErrorCode::unsupported_format, "line 1: binary OFF is not read: export ASCII OFF or PLY");
  }
  cursor = after_word;
  const std::size_t vertex_count = take_count(cursor, "vertices");
  const std::size_t face_count = take_count(cursor, "faces");
  cursor.skip_line();  // the number of edges is not used, and some writers leave it out

  ScanBuilder builder(ScanFormat::off, "face", execution);
  for (std::size_t i = 0; i < vertex_count; ++i) {
    if (i % (1 << 14) == 0) builder.check();
    go_to_content(cursor);
    double values[10];
    std::size_t count = 0;
    for (; count < 10; ++count) {
      const auto number = cursor.take_number();
      if (!number) break;
      values[count] = *number;
    }
    const std::size_t needed = has_normals ? 6 : 3;
    if (count < needed)
      fail(cursor, "vertex " + std::to_string(i) + " needs " + std::to_string(needed) + " numbers");
    builder.add_vertex(values[0], values[1], values[2]);
    if (has_normals) builder.add_normal(values[3], values[4], values[5]);
    // Colours are written with and without the C in the header: what is left of the line tells.
    const std::size_t left = count - needed;
    if (left == 3 || left == 4)
      builder.add_float_colour(values[needed], values[needed + 1], values[needed + 2]);
    cursor.skip_line();
  }
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < face_count; ++i) {
    if (i % (1 << 14) == 0) builder.check();
    go_to_content(cursor);
    const auto size = cursor.take_integer();
    if (!size || *size < 0)
      fail(cursor, "the number of corners of face " + std::to_string(i) + " is missing");
    corners.clear();
    for (std::int64_t k = 0; k < *size; ++k) {
      const auto corner = cursor.take_integer();
      if (!corner)
        fail(cursor, "face " + std::to_string(i) + " needs " + std::to_string(*size) + " vertex indices");
      corners.push_back(*corner);
    }
    builder.add_polygon(corners, i);
    cursor.skip_line();
  }
  return builder.finish();
}

}  // namespace vitruvian
