#include <algorithm>
#include <vector>

#include "io/readers.h"
#include "io/scan_builder.h"
#include "io/text_cursor.h"

namespace vitruvian {
namespace {

/// Skips blanks and line continuations (a backslash at the line's end).
void skip_blanks(TextCursor& cursor) {
  for (;;) {
    cursor.skip_blanks();
    if (cursor.peek() != '\\') return;
    const char* backslash = cursor.position();
    cursor.advance();
    cursor.skip_blanks();
    if (!cursor.at_line_end()) {
      cursor.set_position(backslash);
      return;
    }
    cursor.skip_line();
  }
}

[[noreturn]] void fail(const TextCursor& cursor, const std::string& what) {
  throw Error(ErrorCode::bad_file, cursor.describe(what));
}

/// Goes past the statement's end, following line continuations.
void skip_statement(TextCursor& cursor) {
  for (;;) {
    const std::string_view line = cursor.take_line();
    if (line.empty() || line.back() != '\\' || cursor.at_end()) return;
  }
}

class ObjReader {
 public:
  ObjReader(std::span<const std::byte> bytes, const Execution& execution)
      : cursor_(bytes), builder_(ScanFormat::obj, "line", execution) {}

  Scan read() {
    for (std::size_t line = 0; !cursor_.at_end(); ++line) {
      if (line % (1 << 14) == 0) builder_.check();
      const std::string_view keyword = cursor_.take_word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f" || keyword == "fo") {
        read_face();
      } else if (keyword == "vn") {
        read_normal();
      }
      skip_statement(cursor_);
    }
    if (normal_count_ > 0 && !normals_are_per_vertex_) {
      builder_.drop_normals();
      builder_.add_note("normals left out: they belong to corners of faces, not to vertices");
    }
    return builder_.finish();
  }

 private:
  void read_vertex() {
    double values[7];
    int count = 0;
    for (; count < 7; ++count) {
      skip_blanks(cursor_);
      const auto number = cursor_.take_number();
      if (!number) break;
      values[count] = *number;
    }
    if (count < 3) fail(cursor_, "a vertex needs three numbers");
    builder_.add_vertex(values[0], values[1], values[2]);
    if (count == 6) builder_.add_float_colour(values[3], values[4], values[5]);
    // x y z w r g b, or x y z r g b a: the fourth number tells, because a weight is 1 wherever it is written.
    if (count == 7 && values[3] == 1.0) builder_.add_float_colour(values[4], values[5], values[6]);
    if (count == 7 && values[3] != 1.0) builder_.add_float_colour(values[3], values[4], values[5]);
  }

  void read_normal() {
    double values[3];
    for (double& value : values) {
      skip_blanks(cursor_);
      const auto number = cursor_.take_number();
      if (!number) fail(cursor_, "a normal needs three numbers");
      value = *number;
    }
    builder_.add_normal(values[0], values[1], values[2]);
    ++normal_count_;
  }

  /// The index in the file's spelling (from 1, or negative from the last one) as one from 0.
  std::int64_t resolved(std::int64_t index, std::size_t count) const {
    if (index > 0) return index - 1;
    if (index == 0) fail(cursor_, "index 0: OBJ counts from 1");
    if (-index > static_cast<std::int64_t>(count)) {
      fail(cursor_,
           "index " + std::to_string(index) + " points before the first of " + std::to_string(count));
    }
    return static_cast<std::int64_t>(count) + index;
  }

  void read_face() {
    corners_.clear();
    // Line numbers cost a pass over the text, so faces are placed by counting forward from the last one.
    line_ += static_cast<std::size_t>(std::count(counted_to_, cursor_.position(), '\n'));
    counted_to_ = cursor_.position();
    for (;;) {
      skip_blanks(cursor_);
      if (cursor_.at_line_end() || cursor_.peek() == '#') break;
      const auto vertex = cursor_.take_integer();
      if (!vertex) fail(cursor_, "not a vertex index in a face");
      corners_.push_back(resolved(*vertex, builder_.vertex_count()));
      if (cursor_.peek() == '/') {
        cursor_.advance();
        if (cursor_.peek() != '/' && !cursor_.at_line_end()) read_optional_index();
        if (cursor_.peek() == '/') {
          cursor_.advance();
          const auto normal = read_optional_index();
          if (normal && resolved(*normal, normal_count_) != corners_.back()) normals_are_per_vertex_ = false;
        }
      }
      const char next = cursor_.peek();
      if (!cursor_.at_line_end() && next != ' ' && next != '\t' && next != '\r' && next != '\\') {
        fail(cursor_, "not a vertex index in a face");
      }
    }
    builder_.add_polygon(corners_, line_);
  }

  std::optional<std::int64_t> read_optional_index() {
    const char c = cursor_.peek();
    if (c != '-' && c != '+' && !(c >= '0' && c <= '9')) return std::nullopt;
    const auto index = cursor_.take_integer();
    if (!index) fail(cursor_, "not an index in a face");
    return index;
  }

  TextCursor cursor_;
  ScanBuilder builder_;
  std::vector<std::int64_t> corners_;
  std::size_t normal_count_ = 0;
  bool normals_are_per_vertex_ = true;
  const char* counted_to_ = cursor_.position();
  std::size_t line_ = 1;
};

}  // namespace

Scan read_obj(std::span<const std::byte> bytes, const Execution& execution) {
  return ObjReader(bytes, execution).read();
}

}  // namespace vitruvian
