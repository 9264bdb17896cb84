#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/binary.h"
#include "io/readers.h"
#include "io/scan_builder.h"
#include "io/text_cursor.h"

namespace vitruvian {
namespace {

struct Field {
  std::string name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
};

enum class Encoding { ascii, binary, compressed };

struct Header {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  Encoding encoding = Encoding::ascii;
};

[[noreturn]] void fail(const TextCursor& cursor, const std::string& what) {
  throw Error(ErrorCode::bad_file, cursor.describe(what));
}

std::vector<std::string> words_of(std::string_view line) {
  TextCursor cursor(line);
  std::vector<std::string> words;
  for (std::string_view word = cursor.take_word(); !word.empty(); word = cursor.take_word())
    words.emplace_back(word);
  return words;
}

std::uint64_t to_count(const std::string& word, const TextCursor& cursor) {
  TextCursor inside(word);
  const auto count = inside.take_integer();
  if (!count || *count < 0 || !inside.at_end())
    fail(cursor, "'" + word.substr(0, 40) + "' in the PCD header is not a count");
  return static_cast<std::uint64_t>(*count);
}

/// Reads the header; leaves the cursor on the first byte of the data.
Header read_header(TextCursor& cursor) {
  Header header;
  std::uint64_t width = 0, height = 1;
  bool has_points = false;
  for (;;) {
    if (cursor.at_end()) fail(cursor, "the PCD header has no DATA line");
    const std::vector<std::string> words = words_of(cursor.take_line());
    if (words.empty() || words[0][0] == '#') continue;
    const std::string& keyword = words[0];
    const bool per_field = keyword == "SIZE" || keyword == "TYPE" || keyword == "COUNT";
    if (per_field && words.size() != header.fields.size() + 1)
      fail(cursor, keyword + " does not match FIELDS");
    if (words.size() < 2) fail(cursor, "a PCD header line without a value");
    if (keyword == "FIELDS" || keyword == "COLUMNS") {
      header.fields.clear();
      for (std::size_t k = 1; k < words.size(); ++k) header.fields.push_back({.name = lower_case(words[k])});
    }
    for (std::size_t k = 0; per_field && k < header.fields.size(); ++k) {
      Field& field = header.fields[k];
      if (keyword == "TYPE") {
        field.type = words[k + 1][0];
      } else {
        const std::uint64_t number = to_count(words[k + 1], cursor);
        if (number > 1 << 20) fail(cursor, keyword + " is impossibly large");
        (keyword == "SIZE" ? field.size : field.count) = static_cast<std::size_t>(number);
      }
    }
    if (keyword == "WIDTH") width = to_count(words[1], cursor);
    if (keyword == "HEIGHT") height = to_count(words[1], cursor);
    if (keyword == "POINTS") header.points = to_count(words[1], cursor), has_points = true;
    if (keyword == "DATA") {
      if (words[1] != "ascii" && words[1] != "binary" && words[1] != "binary_compressed") {
        fail(cursor, "unknown PCD data encoding '" + words[1].substr(0, 40) + "'");
      }
      header.encoding = words[1] == "ascii"    ? Encoding::ascii
                        : words[1] == "binary" ? Encoding::binary
                                               : Encoding::compressed;
      break;
    }
  }
  if (!has_points) {
    if (height != 0 && width > std::numeric_limits<std::uint32_t>::max() / height)
      fail(cursor, "WIDTH x HEIGHT is impossibly large");
    header.points = width * height;
  }
  return header;
}

Scalar scalar_of(const Field& field) {
  const auto pick = [&](Scalar one, Scalar two, Scalar four, Scalar eight) -> std::optional<Scalar> {
    switch (field.size) {
      case 1:
        return one;
      case 2:
        return two;
      case 4:
        return four;
      case 8:
        return eight;
      default:
        return std::nullopt;
    }
  };
  std::optional<Scalar> type;
  if (field.type == 'I') type = pick(Scalar::i8, Scalar::i16, Scalar::i32, Scalar::i64);
  if (field.type == 'U') type = pick(Scalar::u8, Scalar::u16, Scalar::u32, Scalar::u64);
  if (field.type == 'F' && field.size == 4) type = Scalar::f32;
  if (field.type == 'F' && field.size == 8) type = Scalar::f64;
  if (!type) {
    throw Error(ErrorCode::bad_file, "PCD field '" + field.name.substr(0, 40) + "' has the unknown type " +
                                         field.type + std::to_string(field.size));
  }
  return *type;
}

/// Decompresses LZF (Marc Lehmann's liblzf), as PCL writes it.
std::vector<std::byte> decompress_lzf(std::span<const std::byte> input, std::size_t size) {
  const auto damaged = [] {
    return Error(ErrorCode::bad_file, "the compressed PCD data is damaged or cut short");
  };
  // A copy of up to 264 bytes takes three.
  if (size / 264 > input.size()) throw damaged();
  std::vector<std::byte> output;
  output.reserve(size);
  std::size_t next = 0;
  const auto take = [&]() -> std::optional<std::size_t> {
    if (next == input.size()) return std::nullopt;
    return std::to_integer<std::size_t>(input[next++]);
  };
  const auto must_take = [&]() {
    const auto byte = take();
    if (!byte) throw damaged();
    return *byte;
  };
  while (const auto control = take()) {
    if (*control < 32) {
      for (std::size_t k = 0; k <= *control; ++k) output.push_back(static_cast<std::byte>(must_take()));
    } else {
      std::size_t length = *control >> 5;
      if (length == 7) length += must_take();
      const std::size_t distance = ((*control & 31) << 8) + must_take() + 1;
      if (distance > output.size()) throw damaged();
      for (std::size_t k = 0; k < length + 2; ++k) output.push_back(output[output.size() - distance]);
    }
    if (output.size() > size) throw damaged();
  }
  if (output.size() != size) throw damaged();
  return output;
}

/// Where one value of every point stands in binary data: byte = offset + point x stride.
struct Column {
  std::size_t first_number = 0;  ///< ASCII: position on the line
  std::size_t offset = 0, stride = 0;
  Scalar type = Scalar::f32;
};

struct Columns {
  std::array<std::optional<Column>, 3> position, normal;
  std::optional<Column> colour;  ///< packed 0x00RRGGBB, as integer or as the bits of a float
  std::size_t numbers = 0;       ///< per point
  std::size_t row_size = 0;      ///< bytes per point
};

Columns find_columns(const Header& header) {
  Columns columns;
  const bool by_field = header.encoding == Encoding::compressed;
  for (const Field& field : header.fields) columns.row_size += field.size * field.count;
  std::size_t offset = 0;
  for (const Field& field : header.fields) {
    Column column{columns.numbers, by_field ? offset * static_cast<std::size_t>(header.points) : offset,
                  by_field ? field.size * field.count : columns.row_size, Scalar::f32};
    const auto use = [&](std::optional<Column>& target) {
      if (field.count == 0) return;
      column.type = scalar_of(field);
      target = column;
    };
    for (int axis = 0; axis < 3; ++axis) {
      const char letter = static_cast<char>('x' + axis);
      if (field.name == std::string(1, letter)) use(columns.position[axis]);
      if (field.name == std::string("normal_") + letter || field.name == std::string("n") + letter)
        use(columns.normal[axis]);
    }
    if ((field.name == "rgb" || field.name == "rgba") && field.size == 4) use(columns.colour);
    columns.numbers += field.count;
    offset += field.size * field.count;
  }
  if (!columns.position[0] || !columns.position[1] || !columns.position[2]) {
    throw Error(ErrorCode::bad_file, "the PCD header has no fields x, y and z");
  }
  return columns;
}

std::uint32_t packed_colour(double value, Scalar type) {
  if (type != Scalar::f32) return value >= 0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0;
  const float as_float = static_cast<float>(value);
  std::uint32_t bits;
  std::memcpy(&bits, &as_float, sizeof bits);
  return bits;
}

/// `value(column)` gives the point's number in that column.
template <class Value>
void add_point(const Columns& columns, const Value& value, std::uint32_t colour, ScanBuilder& builder) {
  builder.add_vertex(value(*columns.position[0]), value(*columns.position[1]), value(*columns.position[2]));
  if (columns.normal[0] && columns.normal[1] && columns.normal[2]) {
    builder.add_normal(value(*columns.normal[0]), value(*columns.normal[1]), value(*columns.normal[2]));
  }
  if (columns.colour) {
    builder.add_colour(static_cast<std::uint8_t>(colour >> 16), static_cast<std::uint8_t>(colour >> 8),
                       static_cast<std::uint8_t>(colour));
  }
}

void read_ascii(TextCursor& cursor, const Header& header, const Columns& columns, ScanBuilder& builder) {
  std::vector<double> row(columns.numbers);
  for (std::uint64_t i = 0; i < header.points; ++i) {
    if (i % (1 << 14) == 0) builder.check();
    for (double& value : row) {
      cursor.skip_space();
      const auto number = cursor.take_number();
      if (!number) {
        fail(cursor, (cursor.at_end() ? "the file ends inside point " : "not a number in point ") +
                         std::to_string(i) + " of " + std::to_string(header.points));
      }
      value = *number;
    }
    const auto value = [&](const Column& column) { return row[column.first_number]; };
    std::uint32_t colour = 0;
    if (columns.colour) colour = packed_colour(value(*columns.colour), columns.colour->type);
    add_point(columns, value, colour, builder);
  }
}

void read_binary(std::span<const std::byte> data, const Header& header, const Columns& columns,
                 ScanBuilder& builder) {
  for (std::size_t i = 0; i < header.points; ++i) {
    if (i % (1 << 15) == 0) builder.check();
    const auto at = [&](const Column& column) { return data.data() + column.offset + i * column.stride; };
    const auto value = [&](const Column& column) { return load_number(column.type, at(column)); };
    add_point(columns, value, columns.colour ? load<std::uint32_t>(at(*columns.colour)) : 0, builder);
  }
}

}  // namespace

Scan read_pcd(std::span<const std::byte> bytes, const Execution& execution) {
  TextCursor cursor(bytes);
  const Header header = read_header(cursor);
  std::size_t row_size = 0, numbers = 0;
  for (const Field& field : header.fields) row_size += field.size * field.count, numbers += field.count;
  std::span<const std::byte> data = bytes.subspan(cursor.offset());
  std::vector<std::byte> unpacked;
  if (header.encoding == Encoding::compressed) {
    if (data.size() < 8) fail(cursor, "the compressed PCD data is missing");
    const std::size_t packed_size = load<std::uint32_t>(data.data());
    const std::size_t unpacked_size = load<std::uint32_t>(data.data() + 4);
    if (packed_size > data.size() - 8) fail(cursor, "the compressed PCD data is cut short");
    unpacked = decompress_lzf(data.subspan(8, packed_size), unpacked_size);
    data = unpacked;
  }
  if (header.points == 0) throw Error(ErrorCode::no_geometry, "the PCD header announces no points");
  const std::size_t smallest_row = header.encoding == Encoding::ascii ? 2 * numbers : row_size;
  const std::size_t room = data.size() + (header.encoding == Encoding::ascii ? 1 : 0);
  if (smallest_row == 0 || header.points > room / smallest_row) {
    throw Error(ErrorCode::bad_file,
                "the PCD header announces " + std::to_string(header.points) +
                    " points, more than the rest of the file holds: it is cut short or damaged");
  }
  const Columns columns = find_columns(header);
  ScanBuilder builder(ScanFormat::pcd, "point", execution);
  builder.leave_out_missing();
  if (header.encoding == Encoding::ascii) {
    read_ascii(cursor, header, columns, builder);
  } else {
    read_binary(data, header, columns, builder);
  }
  return builder.finish();
}

}  // namespace vitruvian
