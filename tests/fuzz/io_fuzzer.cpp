// libFuzzer harness of the readers: clang++ -fsanitize=fuzzer,address,undefined (see README.md here).
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  vitruvian::fuzz::read_any_scan(bytes, "fuzz");
  vitruvian::fuzz::read_any_scan(bytes, "fuzz.stl");
  vitruvian::fuzz::read_any_npz(bytes);
  return 0;
}
