#include "io/scan.h"

#include "base/inflate.h"
#include "base/sha256.h"
#include "io/readers.h"
#include "io/text_cursor.h"

namespace vitruvian {
namespace {

/// Largest unpacked size of a gzipped scan, 8 GiB where the address space allows.
constexpr std::size_t kLargestUnpacked =
    sizeof(std::size_t) > 4 ? std::size_t{8} << (sizeof(std::size_t) > 4 ? 30 : 0) : std::size_t{3} << 29;

std::string without_gz(const std::string& name) {
  const std::string lower = lower_case(name);
  return lower.size() > 3 && lower.compare(lower.size() - 3, 3, ".gz") == 0 ? name.substr(0, name.size() - 3)
                                                                            : name;
}

Scan read_unpacked(std::span<const std::byte> bytes, const std::string& stem_name,
                   const Execution& execution) {
  switch (detect_format(bytes, stem_name)) {
    case ScanFormat::ply:
      return read_ply(bytes, execution);
    case ScanFormat::obj:
      return read_obj(bytes, execution);
    case ScanFormat::stl:
      return read_stl(bytes, execution);
    case ScanFormat::off:
      return read_off(bytes, execution);
    case ScanFormat::glb:
      return read_glb(bytes, execution);
    case ScanFormat::gltf:
      return read_gltf(bytes, execution);
    case ScanFormat::xyz:
      return read_xyz(bytes, execution);
    case ScanFormat::pcd:
      return read_pcd(bytes, execution);
  }
  throw Error(ErrorCode::internal, "unknown scan format");
}

}  // namespace

std::string_view name_of(ScanFormat format) noexcept {
  switch (format) {
    case ScanFormat::ply:
      return "ply";
    case ScanFormat::obj:
      return "obj";
    case ScanFormat::stl:
      return "stl";
    case ScanFormat::off:
      return "off";
    case ScanFormat::glb:
      return "glb";
    case ScanFormat::gltf:
      return "gltf";
    case ScanFormat::xyz:
      return "xyz";
    case ScanFormat::pcd:
      return "pcd";
  }
  return "";
}

Scan read_scan(std::span<const std::byte> bytes, const std::string& file_name, const Execution& execution) {
  Scan scan;
  std::string digest;
  try {
    // Range 0 runs on this thread, so that the reader may report and check as usual; the hash takes the
    // other.
    execution.parallel_for(2, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t task = begin; task < end; ++task) {
        if (task == 1) {
          digest = to_hex(sha256(bytes));
        } else if (is_gzip(bytes)) {
          const std::vector<std::byte> unpacked = inflate_gzip(bytes, kLargestUnpacked);
          scan = read_unpacked(unpacked, without_gz(file_name), execution);
        } else {
          scan = read_unpacked(bytes, without_gz(file_name), execution);
        }
      }
    });
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    throw Error(error.code(), file_name + ": " + error.what());
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::bad_file,
                file_name + ": needs more memory than there is: reduce the scan or use a larger machine");
  }
  scan.file_name = file_name;
  scan.sha256 = std::move(digest);
  return scan;
}

}  // namespace vitruvian
