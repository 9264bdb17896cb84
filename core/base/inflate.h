#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vitruvian {

/// Decompresses one zlib stream (RFC 1950) whose decompressed size is known.
/// @throws Error(bad_file) when the stream is damaged or does not give exactly `size` bytes.
std::vector<std::byte> inflate_zlib(std::span<const std::byte> stream, std::size_t size);

/// Decompresses one bare deflate stream (RFC 1951, as in a zip file) whose decompressed size is known. It
/// carries no check of its own: the caller compares crc32().
/// @throws Error(bad_file) when the stream is damaged or does not give exactly `size` bytes.
std::vector<std::byte> inflate_raw(std::span<const std::byte> stream, std::size_t size);

/// CRC-32 of gzip, zip and PNG (ISO 3309), of `bytes` appended to what gave `previous`.
std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t previous = 0) noexcept;

/// True when the bytes begin like a gzip file (RFC 1952).
bool is_gzip(std::span<const std::byte> bytes) noexcept;

/// Decompresses a gzip file, all of its members, checking each member's CRC-32 and size.
/// @param limit  largest decompressed size accepted, in bytes.
/// @throws Error(bad_file) when damaged, truncated or larger than `limit`.
std::vector<std::byte> inflate_gzip(std::span<const std::byte> bytes, std::size_t limit);

}  // namespace vitruvian
