#include <array>
#include <cmath>
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

struct Property {
  std::string name;
  Scalar type;                      ///< of the value, or of a list's items
  std::optional<Scalar> list_size;  ///< type of a list's length; none for a plain value
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  std::size_t line = 0;

  std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names) {
      for (std::size_t k = 0; k < properties.size(); ++k) {
        if (properties[k].name == name) return k;
      }
    }
    return std::nullopt;
  }
  bool has_lists() const {
    for (const Property& property : properties) {
      if (property.list_size) return true;
    }
    return false;
  }
};

enum class Encoding { ascii, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
};

[[noreturn]] void fail(const TextCursor& cursor, const std::string& what) {
  throw Error(ErrorCode::bad_file, cursor.describe(what));
}

Scalar scalar_named(std::string_view name, const TextCursor& cursor) {
  struct Name {
    std::string_view name;
    Scalar type;
  };
  static constexpr Name kNames[] = {
      {"char", Scalar::i8},   {"int8", Scalar::i8},     {"uchar", Scalar::u8},   {"uint8", Scalar::u8},
      {"short", Scalar::i16}, {"int16", Scalar::i16},   {"ushort", Scalar::u16}, {"uint16", Scalar::u16},
      {"int", Scalar::i32},   {"int32", Scalar::i32},   {"uint", Scalar::u32},   {"uint32", Scalar::u32},
      {"float", Scalar::f32}, {"float32", Scalar::f32}, {"double", Scalar::f64}, {"float64", Scalar::f64},
      {"int64", Scalar::i64}, {"long", Scalar::i64},    {"uint64", Scalar::u64}, {"ulong", Scalar::u64},
  };
  for (const Name& known : kNames) {
    if (known.name == name) return known.type;
  }
  fail(cursor, "unknown property type '" + std::string(name.substr(0, 40)) + "'");
}

/// Reads the header; leaves the cursor on the first byte of the body.
Header read_header(TextCursor& cursor) {
  Header header;
  cursor.skip_line();
  bool has_format = false;
  for (;;) {
    if (cursor.at_end()) fail(cursor, "the PLY header has no 'end_header'");
    const std::string_view keyword = cursor.take_word();
    if (keyword == "end_header") {
      cursor.skip_line();
      break;
    }
    if (keyword == "format") {
      const std::string_view name = cursor.take_word();
      if (name == "ascii") {
        header.encoding = Encoding::ascii;
      } else if (name == "binary_little_endian") {
        header.encoding = Encoding::little_endian;
      } else if (name == "binary_big_endian") {
        header.encoding = Encoding::big_endian;
      } else {
        fail(cursor, "unknown PLY format '" + std::string(name.substr(0, 40)) + "'");
      }
      has_format = true;
    } else if (keyword == "element") {
      Element element;
      element.name = cursor.take_word();
      const auto count = cursor.take_integer();
      if (!count || *count < 0)
        fail(cursor, "the number of '" + element.name.substr(0, 40) + "' elements is missing");
      element.count = static_cast<std::uint64_t>(*count);
      element.line = cursor.line_number();
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) fail(cursor, "a property before any element");
      Property property;
      std::string_view type = cursor.take_word();
      if (type == "list") {
        property.list_size = scalar_named(cursor.take_word(), cursor);
        type = cursor.take_word();
      }
      property.type = scalar_named(type, cursor);
      property.name = lower_case(cursor.take_word());
      header.elements.back().properties.push_back(std::move(property));
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      fail(cursor, "unknown header keyword '" + std::string(keyword.substr(0, 40)) + "'");
    }
    cursor.skip_line();
  }
  if (!has_format) fail(cursor, "the PLY header has no 'format' line");
  return header;
}

/// What one vertex row means: positions of the values in the row.
struct VertexColumns {
  std::array<std::size_t, 3> position;
  std::optional<std::array<std::size_t, 3>> normal, colour;
  Scalar colour_type = Scalar::u8;
};

std::optional<std::array<std::size_t, 3>> find_three(
    const Element& element, const std::array<std::initializer_list<std::string_view>, 3>& names) {
  std::array<std::size_t, 3> columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto found = element.find(names[axis]);
    if (!found || element.properties[*found].list_size) return std::nullopt;
    columns[axis] = *found;
  }
  return columns;
}

VertexColumns vertex_columns(const Element& element) {
  VertexColumns columns;
  const auto position = find_three(element, {{{"x"}, {"y"}, {"z"}}});
  if (!position) {
    throw Error(ErrorCode::bad_file,
                "line " + std::to_string(element.line) + ": the vertex element has no properties x, y and z");
  }
  columns.position = *position;
  columns.normal = find_three(element, {{{"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}}});
  columns.colour = find_three(
      element,
      {{{"red", "r", "diffuse_red"}, {"green", "g", "diffuse_green"}, {"blue", "b", "diffuse_blue"}}});
  if (columns.colour) columns.colour_type = element.properties[(*columns.colour)[0]].type;
  return columns;
}

std::uint8_t to_colour(double value) {
  return value > 0 ? static_cast<std::uint8_t>(std::min(value + 0.5, 255.0)) : std::uint8_t{0};
}

void add_vertex(const VertexColumns& columns, const double* row, ScanBuilder& builder) {
  const auto at = [&](const std::array<std::size_t, 3>& c, int axis) { return row[c[axis]]; };
  builder.add_vertex(at(columns.position, 0), at(columns.position, 1), at(columns.position, 2));
  if (columns.normal)
    builder.add_normal(at(*columns.normal, 0), at(*columns.normal, 1), at(*columns.normal, 2));
  if (!columns.colour) return;
  const double red = at(*columns.colour, 0), green = at(*columns.colour, 1), blue = at(*columns.colour, 2);
  if (columns.colour_type == Scalar::f32 || columns.colour_type == Scalar::f64) {
    builder.add_float_colour(red, green, blue);
  } else {
    const double factor = columns.colour_type == Scalar::u16 ? 1.0 / 257.0 : 1.0;
    builder.add_colour(to_colour(red * factor), to_colour(green * factor), to_colour(blue * factor));
  }
}

/// Triangle strips, one after the other, each ended by -1.
void add_strips(std::span<const std::int64_t> corners, std::size_t place, ScanBuilder& builder) {
  std::size_t length = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (corners[k] < 0) {
      length = 0;
      continue;
    }
    if (++length < 3) continue;
    const bool odd = length % 2 == 0;
    builder.add_triangle(corners[k - (odd ? 1 : 2)], corners[k - (odd ? 2 : 1)], corners[k], place);
  }
}

/// Where the corners of a face element's rows stand, and how to read them.
struct FaceColumn {
  std::size_t property;
  bool strips;
};

std::optional<FaceColumn> face_column(const Element& element) {
  if (element.name != "face" && element.name != "tristrips") return std::nullopt;
  const auto found = element.find({"vertex_indices", "vertex_index"});
  if (!found || !element.properties[*found].list_size) return std::nullopt;
  return FaceColumn{*found, element.name == "tristrips"};
}

std::int64_t to_index(double value) {
  constexpr double kLargest = std::numeric_limits<std::int32_t>::max();
  return value >= -1 && value <= kLargest ? static_cast<std::int64_t>(value) : std::int64_t{1} << 40;
}

/// One value or list of the body, in either encoding, read in order.
class BodyReader {
 public:
  BodyReader(TextCursor& cursor, Encoding encoding)
      : cursor_(cursor), binary_(encoding != Encoding::ascii), swap_(encoding == Encoding::big_endian) {}

  bool binary() const { return binary_; }
  bool swap() const { return swap_; }
  const std::byte* data() const { return reinterpret_cast<const std::byte*>(cursor_.position()); }
  std::size_t remaining() const { return cursor_.remaining(); }
  void skip(std::size_t bytes) { cursor_.set_position(cursor_.position() + bytes); }
  double value(Scalar type, const Element& element, std::size_t row) {
    if (binary_) {
      if (remaining() < size_of(type)) fail_at(element, row, "the file ends inside");
      const double number = load_number(type, data(), swap_);
      skip(size_of(type));
      return number;
    }
    cursor_.skip_space();
    const auto number = cursor_.take_number();
    if (!number) fail_at(element, row, cursor_.at_end() ? "the file ends inside" : "not a number in");
    return *number;
  }

  std::size_t list_size(Scalar size_type, Scalar item_type, const Element& element, std::size_t row) {
    const double size = value(size_type, element, row);
    const std::size_t room = binary_ ? remaining() / size_of(item_type) : (remaining() + 1) / 2;
    if (!(size >= 0) || size > static_cast<double>(room) || size != std::floor(size)) {
      fail_at(element, row, "a list longer than the rest of the file in");
    }
    return static_cast<std::size_t>(size);
  }

  [[noreturn]] void fail_at(const Element& element, std::size_t row, const std::string& what) const {
    const std::string text =
        what + " " + element.name + " " + std::to_string(row) + " of " + std::to_string(element.count);
    if (!binary_) throw Error(ErrorCode::bad_file, cursor_.describe(text));
    throw Error(ErrorCode::bad_file, "byte " + std::to_string(cursor_.offset()) + ": " + text +
                                         ": the file is damaged or cut short, export or copy it again");
  }

 private:
  TextCursor& cursor_;
  bool binary_;
  bool swap_;
};

constexpr std::size_t kRowsBetweenChecks = 1 << 15;

void read_plain_vertices(const Element& element, const VertexColumns& columns, BodyReader& body,
                         ScanBuilder& builder) {
  std::vector<double> row(element.properties.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    if (i % kRowsBetweenChecks == 0) builder.check();
    if (body.binary()) {
      const std::byte* data = body.data();
      for (std::size_t k = 0; k < row.size(); ++k) {
        row[k] = load_number(element.properties[k].type, data, body.swap());
        data += size_of(element.properties[k].type);
      }
      body.skip(static_cast<std::size_t>(data - body.data()));
    } else {
      for (std::size_t k = 0; k < row.size(); ++k)
        row[k] = body.value(element.properties[k].type, element, i);
    }
    add_vertex(columns, row.data(), builder);
  }
}

void read_rows(const Element& element, const VertexColumns* vertex, const std::optional<FaceColumn>& face,
               BodyReader& body, ScanBuilder& builder) {
  std::vector<double> row(element.properties.size());
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    if (i % kRowsBetweenChecks == 0) builder.check();
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const Property& property = element.properties[k];
      if (!property.list_size) {
        row[k] = body.value(property.type, element, i);
        continue;
      }
      const std::size_t size = body.list_size(*property.list_size, property.type, element, i);
      const bool is_face = face && face->property == k;
      if (body.binary() && !is_face) {
        body.skip(size * size_of(property.type));
        continue;
      }
      corners.clear();
      for (std::size_t n = 0; n < size; ++n) {
        const double item = body.value(property.type, element, i);
        if (is_face) corners.push_back(to_index(item));
      }
      if (!is_face) continue;
      if (face->strips) {
        add_strips(corners, i, builder);
      } else {
        builder.add_polygon(corners, i);
      }
    }
    if (vertex) add_vertex(*vertex, row.data(), builder);
  }
}

/// Refuses counts that the rest of the file cannot hold.
void check_count(const Element& element, const BodyReader& body) {
  std::size_t smallest_row = 0;
  for (const Property& property : element.properties) {
    smallest_row += body.binary() ? size_of(property.list_size.value_or(property.type)) : 2;
  }
  // The last number of an ASCII file may lack its separator.
  const std::size_t room = (body.remaining() + (body.binary() ? 0 : 1)) / smallest_row;
  if (element.count > room) {
    throw Error(ErrorCode::bad_file, "line " + std::to_string(element.line) + ": the header announces " +
                                         std::to_string(element.count) + " '" + element.name.substr(0, 40) +
                                         "' elements, but the rest of the file has room for no more than " +
                                         std::to_string(room) + ": the file is cut short or damaged");
  }
}

}  // namespace

Scan read_ply(std::span<const std::byte> bytes, const Execution& execution) {
  TextCursor cursor(bytes);
  Header header = read_header(cursor);
  BodyReader body(cursor, header.encoding);
  ScanBuilder builder(ScanFormat::ply, "face", execution);
  bool has_vertices = false;
  for (const Element& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    if (is_vertex && has_vertices) {
      throw Error(ErrorCode::bad_file, "line " + std::to_string(element.line) + ": a second vertex element");
    }
    std::optional<VertexColumns> columns;
    if (is_vertex) columns = vertex_columns(element), has_vertices = true;
    if (element.properties.empty() || element.count == 0) continue;
    check_count(element, body);
    const std::optional<FaceColumn> face = face_column(element);
    if (element.name == "face" && !face)
      builder.add_note("faces have no vertex_indices list and are left out");
    if (element.has_lists()) {
      read_rows(element, columns ? &*columns : nullptr, face, body, builder);
    } else if (columns) {
      read_plain_vertices(element, *columns, body, builder);
    } else {
      read_rows(element, nullptr, std::nullopt, body, builder);
    }
  }
  return builder.finish();
}

}  // namespace vitruvian
