#pragma once

#include <cstdlib>
#include <span>

#include "base/error.h"
#include "io/npz.h"
#include "io/scan.h"

namespace vitruvian::fuzz {

/// Reads any bytes as a scan. Only vitruvian::Error may come out, and a scan that is accepted keeps its
/// promises. Returns true when it was accepted; aborts when a promise is broken.
inline bool read_any_scan(std::span<const std::byte> bytes, const char* name) {
  try {
    const Scan scan = read_scan(bytes, name, Execution(1));
    const auto count = static_cast<std::size_t>(scan.vertices.cols());
    const bool faces_valid = scan.faces.cols() == 0 ||
                             (scan.faces.minCoeff() >= 0 && scan.faces.maxCoeff() < scan.vertices.cols());
    const bool attributes_fit = (scan.colours.empty() || scan.colours.size() == 3 * count) &&
                                (scan.normals.cols() == 0 || scan.normals.cols() == scan.vertices.cols());
    if (count < 4 || !faces_valid || !attributes_fit || !scan.vertices.allFinite() ||
        !scan.normals.allFinite() || !scan.origin.allFinite()) {
      std::abort();
    }
    return true;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) std::abort();
    return false;
  }
}

/// Reads any bytes as .npz; every member as number and as text.
inline bool read_any_npz(std::span<const std::byte> bytes) {
  try {
    const NpzFile file(bytes, "fuzz.npz");
    for (const std::string& name : file.names()) {
      try {
        file.array(name);
      } catch (const Error&) {
        file.text(name);
      }
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace vitruvian::fuzz
