// libFuzzer harness of the model readers: clang++ -fsanitize=fuzzer,address,undefined (see README.md here).
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_models.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vitruvian::fuzz::read_any_model({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
