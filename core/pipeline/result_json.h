#pragma once

#include <string>
#include <string_view>

#include "pipeline/registration.h"

namespace vitruvian {

enum class JsonStyle {
  compact,  ///< one line
  pretty,   ///< indented, rows of numbers on one line, newline at the end
};

/// registration.json of contract.md. Numbers of the alignment, the parameters and the joints carry all their
/// digits, so that the mesh can be rebuilt from them; measured errors are rounded to 0.1 micrometres. What is
/// unknown (alignment without a method, parameters, surface error) and whatever is not finite becomes null.
/// @param version  of the program.
std::string registration_json(const Registration& registration, std::string_view version, JsonStyle style);

/// Reads a registration.json back; the mesh and per-vertex errors stay empty. Members the contract lets be
/// null may be.
/// @param file_name  shown in errors.
/// @throws Error(bad_file) naming the place, e.g. "joints[3].scan", and what is wrong there.
Registration parse_registration(std::string_view text, const std::string& file_name);

/// `{"scan", "error": {"code", "message"}}` on one line: what --json prints for a scan that gave no
/// registration.
std::string error_json(std::string_view scan, std::string_view code, std::string_view message);

}  // namespace vitruvian
