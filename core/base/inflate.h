#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vitruvian {

/// Decompresses one zlib stream (RFC 1950) whose decompressed size is known.
/// @throws Error(bad_file) when the stream is damaged or does not give exactly `size` bytes.
std::vector<std::byte> inflate_zlib(std::span<const std::byte> stream, std::size_t size);

/// True when the bytes begin like a gzip file (RFC 1952).
bool is_gzip(std::span<const std::byte> bytes) noexcept;

/// Decompresses a gzip file, all of its members, checking each member's CRC-32 and size.
/// @param limit  largest decompressed size accepted, in bytes.
/// @throws Error(bad_file) when damaged, truncated or larger than `limit`.
std::vector<std::byte> inflate_gzip(std::span<const std::byte> bytes, std::size_t limit);

}  // namespace vitruvian
