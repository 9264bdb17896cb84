#include "base/inflate.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>

#include "base/error.h"

// stb_image's zlib decoder, with every image format switched off: header-only, so that native and WASM builds
// share it.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_NO_JPEG
#define STBI_NO_PNG
#define STBI_NO_BMP
#define STBI_NO_PSD
#define STBI_NO_TGA
#define STBI_NO_GIF
#define STBI_NO_PIC
#define STBI_NO_PNM
#define STBI_SUPPORT_ZLIB
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace vitruvian {
namespace {

/// Deflate cannot expand by more than this: 258 bytes from a length and a distance code of one bit each.
constexpr std::size_t kLargestRatio = 1032;

enum class Outcome { complete, output_full, damaged };

struct Inflated {
  Outcome outcome;
  std::size_t consumed;  ///< bytes of input up to the end of the deflate stream
  std::size_t produced;
};

/// Inflates a bare deflate stream. The decoder reads ahead, so at least four bytes must follow the stream's
/// last one. The decoder's own state is used instead of its outer functions, because those neither tell where
/// the stream ended nor go beyond 2 GiB.
Inflated inflate(std::span<const std::byte> input, std::span<std::byte> output) {
  stbi__zbuf state{};
  auto* begin = reinterpret_cast<stbi_uc*>(const_cast<std::byte*>(input.data()));
  state.zbuffer = begin;
  state.zbuffer_end = begin + input.size();
  state.zout = state.zout_start = reinterpret_cast<char*>(output.data());
  state.zout_end = state.zout_start + output.size();
  state.z_expandable = 0;
  stbi__g_failure_reason = "";
  if (!stbi__parse_zlib(&state, 0)) {
    const bool full = std::string_view(stbi__g_failure_reason) == "output buffer limit";
    return {full ? Outcome::output_full : Outcome::damaged, 0, 0};
  }
  const std::size_t read = static_cast<std::size_t>(state.zbuffer - begin);
  const std::size_t unused = static_cast<std::size_t>(state.num_bits) / 8;
  return {Outcome::complete, read - std::min(read, unused),
          static_cast<std::size_t>(state.zout - state.zout_start)};
}

/// The decoder compares and copies through its output pointer even when nothing is written: never give it a
/// null one.
std::vector<std::byte> output_buffer(std::size_t size) {
  std::vector<std::byte> output;
  output.reserve(std::max<std::size_t>(size, 1));
  output.resize(size);
  return output;
}

void check_ratio(std::size_t stream_size, std::size_t size) {
  if (size / kLargestRatio > stream_size) {
    throw Error(ErrorCode::bad_file, "compressed data of " + std::to_string(stream_size) +
                                         " bytes cannot hold " + std::to_string(size) +
                                         " bytes: the file is damaged");
  }
}

void check_inflated(const Inflated& result, std::size_t size) {
  if (result.outcome == Outcome::damaged)
    throw Error(ErrorCode::bad_file, "compressed data is damaged or cut short");
  if (result.outcome == Outcome::output_full || result.produced != size) {
    throw Error(ErrorCode::bad_file,
                "compressed data does not have the announced size of " + std::to_string(size) + " bytes");
  }
}

std::uint32_t adler32(std::span<const std::byte> bytes) {
  std::uint32_t a = 1, b = 0;
  while (!bytes.empty()) {
    // 5552 is the longest run whose sums stay below 2^32.
    const auto run = bytes.first(std::min<std::size_t>(bytes.size(), 5552));
    for (const std::byte byte : run) {
      a += std::to_integer<std::uint32_t>(byte);
      b += a;
    }
    a %= 65521;
    b %= 65521;
    bytes = bytes.subspan(run.size());
  }
  return b << 16 | a;
}

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t position) {
  return std::to_integer<std::uint32_t>(bytes[position]);
}

std::uint32_t little_endian_u32(std::span<const std::byte> bytes, std::size_t position) {
  return byte_at(bytes, position) | byte_at(bytes, position + 1) << 8 | byte_at(bytes, position + 2) << 16 |
         byte_at(bytes, position + 3) << 24;
}

using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables make_crc_tables() {
  CrcTables tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1) ? 0xedb88320u ^ (value >> 1) : value >> 1;
    tables[0][i] = value;
  }
  for (std::uint32_t i = 0; i < 256; ++i) {
    for (int k = 1; k < 8; ++k) tables[k][i] = tables[0][tables[k - 1][i] & 255] ^ (tables[k - 1][i] >> 8);
  }
  return tables;
}

constexpr CrcTables kCrc = make_crc_tables();

/// Length of a member's gzip header (RFC 1952, 2.3).
std::size_t gzip_header_size(std::span<const std::byte> member) {
  const auto cut_short = [] { return Error(ErrorCode::bad_file, "gzip data is cut short in a header"); };
  if (member.size() < 18) throw cut_short();
  const std::uint32_t flags = byte_at(member, 3);
  if (byte_at(member, 2) != 8 || (flags & 0xe0) != 0) {
    throw Error(ErrorCode::bad_file, "gzip header asks for an unknown compression method");
  }
  std::size_t position = 10;
  if (flags & 4) position += 2 + byte_at(member, 10) + (byte_at(member, 11) << 8);
  for (const std::uint32_t text_flag : {8u, 16u}) {
    if (!(flags & text_flag)) continue;
    while (position < member.size() && byte_at(member, position) != 0) ++position;
    ++position;
  }
  if (flags & 2) position += 2;
  if (position + 8 > member.size()) throw cut_short();
  return position;
}

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t previous) noexcept {
  std::uint32_t crc = ~previous;
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    const std::uint32_t low = crc ^ little_endian_u32(bytes, 0);
    crc = kCrc[7][low & 255] ^ kCrc[6][low >> 8 & 255] ^ kCrc[5][low >> 16 & 255] ^ kCrc[4][low >> 24] ^
          kCrc[3][byte_at(bytes, 4)] ^ kCrc[2][byte_at(bytes, 5)] ^ kCrc[1][byte_at(bytes, 6)] ^
          kCrc[0][byte_at(bytes, 7)];
  }
  for (const std::byte byte : bytes) {
    crc = kCrc[0][(crc ^ std::to_integer<std::uint32_t>(byte)) & 255] ^ (crc >> 8);
  }
  return ~crc;
}

std::vector<std::byte> inflate_zlib(std::span<const std::byte> stream, std::size_t size) {
  if (stream.size() < 6) throw Error(ErrorCode::bad_file, "compressed data is cut short");
  const std::uint32_t header = byte_at(stream, 0) << 8 | byte_at(stream, 1);
  if (header % 31 != 0 || (header >> 8 & 15) != 8 || (header & 32) != 0) {
    throw Error(ErrorCode::bad_file, "compressed data does not begin like a zlib stream");
  }
  check_ratio(stream.size(), size);
  std::vector<std::byte> output = output_buffer(size);
  const std::span<const std::byte> body = stream.subspan(2);
  const Inflated result = inflate(body, output);
  check_inflated(result, size);
  if (result.consumed + 4 != body.size()) {
    throw Error(ErrorCode::bad_file, "compressed data does not end where it should");
  }
  const auto tail = body.subspan(result.consumed);
  const std::uint32_t stored =
      byte_at(tail, 0) << 24 | byte_at(tail, 1) << 16 | byte_at(tail, 2) << 8 | byte_at(tail, 3);
  if (adler32(output) != stored)
    throw Error(ErrorCode::bad_file, "compressed data fails its checksum: it is damaged");
  return output;
}

std::vector<std::byte> inflate_raw(std::span<const std::byte> stream, std::size_t size) {
  check_ratio(stream.size(), size);
  std::vector<std::byte> padded(stream.size() + 8);
  std::copy(stream.begin(), stream.end(), padded.begin());
  std::vector<std::byte> output = output_buffer(size);
  const Inflated result = inflate(padded, output);
  check_inflated(result, size);
  if (result.consumed != stream.size()) {
    throw Error(ErrorCode::bad_file, "compressed data does not end where it should");
  }
  return output;
}

bool is_gzip(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= 2 && byte_at(bytes, 0) == 0x1f && byte_at(bytes, 1) == 0x8b;
}

std::vector<std::byte> inflate_gzip(std::span<const std::byte> bytes, std::size_t limit) {
  std::vector<std::byte> output = output_buffer(0);
  if (!is_gzip(bytes)) throw Error(ErrorCode::bad_file, "data does not begin like a gzip file");
  std::span<const std::byte> rest = bytes;
  while (!rest.empty()) {
    if (!is_gzip(rest)) {
      // Archives are sometimes padded with zeros to a block size.
      if (std::all_of(rest.begin(), rest.end(), [](std::byte byte) { return byte == std::byte{0}; })) break;
      throw Error(ErrorCode::bad_file, "gzip data is followed by something else at byte " +
                                           std::to_string(bytes.size() - rest.size()));
    }
    const std::span<const std::byte> body = rest.subspan(gzip_header_size(rest));
    const std::size_t done = output.size();
    // Written so that it cannot overflow where std::size_t has 32 bits.
    const std::size_t allowed = limit - done;
    const bool ratio_binds = body.size() < allowed / kLargestRatio;
    const std::size_t largest = ratio_binds ? body.size() * kLargestRatio : allowed;
    // The last four bytes of a file of one member are its size; members of many-member files are small.
    const std::size_t guess = done == 0 ? little_endian_u32(bytes, bytes.size() - 4) : std::size_t{65536};
    std::size_t capacity = std::min(guess, largest);
    Inflated result{};
    for (;;) {
      output.resize(done + capacity);
      result = inflate(body, std::span(output).subspan(done));
      if (result.outcome != Outcome::output_full) break;
      if (capacity >= largest) {
        if (ratio_binds) throw Error(ErrorCode::bad_file, "gzip data is damaged or cut short");
        throw Error(ErrorCode::bad_file,
                    "gzip data unpacks to more than the " + std::to_string(limit) + " bytes allowed");
      }
      capacity = std::min(largest, std::max<std::size_t>(2 * capacity, 65536));
    }
    if (result.outcome == Outcome::damaged || result.consumed + 8 > body.size()) {
      throw Error(ErrorCode::bad_file, "gzip data is damaged or cut short");
    }
    output.resize(done + result.produced);
    const auto trailer = body.subspan(result.consumed, 8);
    const bool same_size = little_endian_u32(trailer, 4) == static_cast<std::uint32_t>(result.produced);
    if (!same_size || crc32(std::span(output).subspan(done)) != little_endian_u32(trailer, 0)) {
      throw Error(ErrorCode::bad_file, "gzip data fails its checksum: it is damaged");
    }
    rest = body.subspan(result.consumed + 8);
  }
  return output;
}

}  // namespace vitruvian
