#include "smpl/read_model.h"

#include <cstring>

namespace vitruvian {

bool is_array_file(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= 8 && std::memcmp(bytes.data(), "VITRUARR", 8) == 0;
}

BodyModel read_any_body_model(std::span<const std::byte> bytes, const std::string& file_name,
                              const SmplOptions& options) {
  return is_array_file(bytes) ? read_body_model(bytes, file_name)
                              : read_smpl_model(bytes, file_name, options);
}

}  // namespace vitruvian
