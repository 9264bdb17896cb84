#include <string>

#include "io/binary.h"
#include "io/readers.h"
#include "io/scan_builder.h"
#include "io/text_cursor.h"

namespace vitruvian {
namespace {

constexpr std::size_t kBinaryHeader = 84, kFacetSize = 50;

void add_facet(ScanBuilder& builder, std::size_t facet) {
  const auto first = static_cast<std::int64_t>(3 * facet);
  builder.add_triangle(first, first + 1, first + 2, facet);
}

Scan read_binary(std::span<const std::byte> bytes, const Execution& execution) {
  if (bytes.size() < kBinaryHeader) {
    throw Error(ErrorCode::bad_file, "too short for an STL file: " + std::to_string(bytes.size()) + " bytes");
  }
  const std::size_t count = load<std::uint32_t>(bytes.data() + 80);
  const std::size_t room = (bytes.size() - kBinaryHeader) / kFacetSize;
  if (count > room) {
    throw Error(ErrorCode::bad_file, "byte 80: announces " + std::to_string(count) +
                                         " facets, but the file has room for " + std::to_string(room) +
                                         ": it is cut short or damaged, export or copy it again");
  }
  ScanBuilder builder(ScanFormat::stl, "facet", execution);
  for (std::size_t facet = 0; facet < count; ++facet) {
    if (facet % (1 << 14) == 0) builder.check();
    const std::byte* corner = bytes.data() + kBinaryHeader + facet * kFacetSize + 12;
    for (int k = 0; k < 3; ++k, corner += 12) {
      builder.add_vertex(load<float>(corner), load<float>(corner + 4), load<float>(corner + 8));
    }
    add_facet(builder, facet);
  }
  const std::size_t extra = bytes.size() - kBinaryHeader - count * kFacetSize;
  if (extra > 0) builder.add_note(counted(extra, "byte", "bytes") + " after the last facet left unread");
  return builder.finish();
}

Scan read_ascii(std::span<const std::byte> bytes, const Execution& execution) {
  TextCursor cursor(bytes);
  ScanBuilder builder(ScanFormat::stl, "facet", execution);
  std::size_t corners = 0, line = 0;
  for (; !cursor.at_end(); cursor.skip_line()) {
    if (++line % (1 << 14) == 0) builder.check();
    const std::string keyword = lower_case(cursor.take_word().substr(0, 16));
    if (keyword == "vertex") {
      double position[3];
      for (double& coordinate : position) {
        const auto number = cursor.take_number();
        if (!number) throw Error(ErrorCode::bad_file, cursor.describe("a vertex needs three numbers"));
        coordinate = *number;
      }
      if (corners == 3) {
        throw Error(ErrorCode::bad_file,
                    cursor.describe("a facet with more than three vertices; STL has triangles only"));
      }
      builder.add_vertex(position[0], position[1], position[2]);
      if (++corners == 3) add_facet(builder, builder.vertex_count() / 3 - 1);
    } else if (keyword == "endloop" || keyword == "endfacet") {
      if (corners != 3 && !(keyword == "endfacet" && corners == 0)) {
        throw Error(ErrorCode::bad_file, cursor.describe("a facet with fewer than three vertices"));
      }
      corners = 0;
    }
  }
  if (corners != 0)
    throw Error(ErrorCode::bad_file, cursor.describe("the file ends inside a facet: it is cut short"));
  return builder.finish();
}

}  // namespace

bool is_sized_like_binary_stl(std::span<const std::byte> bytes) {
  if (bytes.size() < kBinaryHeader) return false;
  const std::uint64_t count = load<std::uint32_t>(bytes.data() + 80);
  return count > 0 && bytes.size() == kBinaryHeader + count * kFacetSize;
}

Scan read_stl(std::span<const std::byte> bytes, const Execution& execution) {
  TextCursor cursor(bytes);
  cursor.skip_space();
  const bool begins_like_text = lower_case(cursor.take_word().substr(0, 5)) == "solid";
  return begins_like_text && !is_sized_like_binary_stl(bytes) ? read_ascii(bytes, execution)
                                                              : read_binary(bytes, execution);
}

}  // namespace vitruvian
