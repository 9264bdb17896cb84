#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "io/readers.h"
#include "io/scan_builder.h"
#include "io/text_cursor.h"

namespace vitruvian {
namespace {

constexpr std::size_t kMostColumns = 16;
constexpr std::size_t kLinesLookedAt = 200;

/// How the columns of a text cloud are separated and what they hold; found from the header line, if there is
/// one, and the first lines of data.
struct Layout {
  char separator = '\0';       ///< besides blanks; 0 for none
  bool decimal_comma = false;  ///< 0,12 0,34 1,56
  std::array<std::size_t, 3> position = {0, 1, 2};
  std::optional<std::size_t> normal, colour;  ///< first of three columns
  std::size_t columns_needed = 3;
};

struct Row {
  std::array<double, kMostColumns> values;
  std::size_t count = 0;
  bool clean = true;  ///< nothing but numbers on the line
};

bool is_comment(std::string_view line) {
  return line.empty() || line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//";
}

/// 12,34 with exactly one comma.
bool is_decimal_comma_number(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos || comma == 0 || comma + 1 == word.size()) return false;
  return word.find_first_not_of("0123456789+-eE", comma + 1) == std::string_view::npos &&
         word.substr(0, comma).find_first_not_of("0123456789+-") == std::string_view::npos;
}

Row take_row(TextCursor& cursor, const Layout& layout) {
  Row row;
  while (row.count < kMostColumns) {
    cursor.skip_blanks();
    if (cursor.at_line_end()) break;
    std::optional<double> number;
    if (layout.decimal_comma) {
      std::string word(cursor.take_word());
      while (!word.empty() && word.back() == ';') word.pop_back();
      std::replace(word.begin(), word.end(), ',', '.');
      TextCursor inside(word);
      number = inside.take_number();
      if (!inside.at_end()) number.reset();
    } else {
      number = cursor.take_number(layout.separator);
    }
    if (!number) {
      row.clean = false;
      break;
    }
    row.values[row.count++] = *number;
    cursor.skip_blanks();
    if (layout.separator && cursor.peek() == layout.separator) cursor.advance();
  }
  return row;
}

Layout find_separators(TextCursor cursor) {
  Layout layout;
  for (std::size_t n = 0; n < kLinesLookedAt && !cursor.at_end(); ++n) {
    const std::string_view line = cursor.take_line();
    if (is_comment(line) || line.find_first_of("0123456789") == std::string_view::npos) continue;
    TextCursor inside(line);
    std::size_t words = 0, commas = 0;
    for (std::string_view word = inside.take_word(); !word.empty(); word = inside.take_word()) {
      while (!word.empty() && word.back() == ';') word.remove_suffix(1);
      ++words;
      commas += is_decimal_comma_number(word);
    }
    if (words >= 3 && commas >= 3) {
      layout.decimal_comma = true;
      return layout;
    }
    for (const char separator : {';', ','}) {
      if (line.find(separator) == std::string_view::npos) continue;
      layout.separator = separator;
      return layout;
    }
  }
  return layout;
}

/// Meaning of the columns behind x y z, from the numbers themselves: unit vectors are normals, integers
/// 0..255 colours.
void find_columns(TextCursor cursor, Layout& layout) {
  std::size_t columns = kMostColumns, rows = 0;
  std::array<bool, kMostColumns> unit{}, byte{};
  unit.fill(true), byte.fill(true);
  for (std::size_t n = 0; n < kLinesLookedAt && !cursor.at_end(); ++n, cursor.skip_line()) {
    const Row row = take_row(cursor, layout);
    if (row.count < 3 || !row.clean) continue;
    ++rows;
    columns = std::min(columns, row.count);
    for (std::size_t k = 3; k + 3 <= row.count; ++k) {
      const double* v = row.values.data() + k;
      unit[k] = unit[k] && std::abs(std::hypot(v[0], v[1], v[2]) - 1) < 0.02;
      byte[k] =
          byte[k] && std::all_of(v, v + 3, [](double c) { return c >= 0 && c <= 255 && c == std::floor(c); });
    }
  }
  if (rows == 0) return;
  // x y z, then perhaps an intensity, then colours and normals in either order.
  for (std::size_t k = 3; k + 3 <= columns;) {
    if (!layout.normal && unit[k]) {
      layout.normal = k;
      k += 3;
    } else if (!layout.colour && byte[k] && (columns - k) % 3 == 0) {
      layout.colour = k;
      k += 3;
    } else {
      ++k;
    }
  }
  if (layout.normal) layout.columns_needed = std::max(layout.columns_needed, *layout.normal + 3);
  if (layout.colour) layout.columns_needed = std::max(layout.columns_needed, *layout.colour + 3);
}

}  // namespace

Scan read_xyz(std::span<const std::byte> bytes, const Execution& execution) {
  TextCursor cursor(bytes);
  Layout layout = find_separators(cursor);
  find_columns(cursor, layout);
  ScanBuilder builder(ScanFormat::xyz, "line", execution);
  for (std::size_t line = 0; !cursor.at_end(); ++line, cursor.skip_line()) {
    if (line % (1 << 14) == 0) builder.check();
    cursor.skip_blanks();
    if (cursor.at_line_end() || cursor.peek() == '#' || cursor.peek() == '%' || cursor.peek() == '/')
      continue;
    const char* line_begin = cursor.position();
    const Row row = take_row(cursor, layout);
    const bool before_data = builder.vertex_count() == 0;
    // In front of the data: a line of column names, or (PTS) the number of points.
    if (before_data && (row.count == 0 || (row.count == 1 && row.clean))) continue;
    if (row.count == 1 && row.clean && row.values[0] == std::floor(row.values[0])) {
      // PTS files of several stations repeat the count in front of each one's points.
      continue;
    }
    if (row.count < layout.columns_needed || (!row.clean && row.count < 3)) {
      if (!row.clean) throw Error(ErrorCode::bad_file, cursor.describe("not a number"));
      cursor.set_position(line_begin);
      throw Error(ErrorCode::bad_file,
                  cursor.describe("a point with " + std::to_string(row.count) + " numbers, where " +
                                  std::to_string(layout.columns_needed) + " are needed"));
    }
    const double* v = row.values.data();
    builder.add_vertex(v[0], v[1], v[2]);
    if (layout.normal) builder.add_normal(v[*layout.normal], v[*layout.normal + 1], v[*layout.normal + 2]);
    if (layout.colour) {
      const auto channel = [&](std::size_t k) {
        return static_cast<std::uint8_t>(std::clamp(v[*layout.colour + k], 0.0, 255.0));
      };
      builder.add_colour(channel(0), channel(1), channel(2));
    }
  }
  return builder.finish();
}

}  // namespace vitruvian
