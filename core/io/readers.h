#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "base/execution.h"
#include "io/scan.h"

namespace vitruvian {

// One reader a format, for read_scan() alone. Each gets the unpacked bytes, and leaves `file_name` and
// `sha256` empty; its errors name the place in the file but not the file.
Scan read_ply(std::span<const std::byte> bytes, const Execution& execution);
Scan read_obj(std::span<const std::byte> bytes, const Execution& execution);
Scan read_stl(std::span<const std::byte> bytes, const Execution& execution);
Scan read_off(std::span<const std::byte> bytes, const Execution& execution);
Scan read_glb(std::span<const std::byte> bytes, const Execution& execution);
Scan read_gltf(std::span<const std::byte> bytes, const Execution& execution);
Scan read_xyz(std::span<const std::byte> bytes, const Execution& execution);
Scan read_pcd(std::span<const std::byte> bytes, const Execution& execution);

/// The format that the content shows (the name's extension breaks ties).
/// @param stem_name  the file's name without .gz.
/// @throws Error(unsupported_format) naming what the file seems to be, and the mend.
ScanFormat detect_format(std::span<const std::byte> bytes, std::string_view stem_name);

/// True when 84 + 50 x (triangle count at byte 80) is the file's size: binary STL, whatever its header says.
bool is_sized_like_binary_stl(std::span<const std::byte> bytes);

}  // namespace vitruvian
