#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace vitruvian {

/// SHA-256 (FIPS 180-4), fed in pieces. Own code because no package offers one to both native and WASM
/// builds.
class Sha256 {
 public:
  using Digest = std::array<std::uint8_t, 32>;

  Sha256();
  void update(std::span<const std::byte> bytes);
  /// The digest of everything fed so far; the object must not be used afterwards.
  Digest finish();

 private:
  void block(const std::uint8_t* bytes);
  std::array<std::uint32_t, 8> state_;
  std::array<std::uint8_t, 64> pending_{};
  std::size_t pending_size_ = 0;
  std::uint64_t total_bytes_ = 0;
};

Sha256::Digest sha256(std::span<const std::byte> bytes);
/// 64 lower-case hexadecimal digits.
std::string to_hex(const Sha256::Digest& digest);

}  // namespace vitruvian
