#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "base/execution.h"
#include "io/scan.h"

namespace vitruvian {

// The only place of the core that knows a file system. Paths are UTF-8.

/// The bytes of a file, mapped into memory where the system can do that, else read. Movable, not copyable.
/// The file must not be shortened while it is mapped.
class FileBytes {
 public:
  /// @throws Error(cannot_read) with the system's reason; also for directories.
  explicit FileBytes(const std::string& path);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  void release() noexcept;

  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
};

/// Writes a file whole or not at all: under a temporary name in the same folder, then renamed over `path`.
/// @throws Error(cannot_write) with the system's reason; nothing is left behind then.
void write_file(const std::string& path, std::string_view content);

/// Makes a folder and its parents; one that exists already is fine.
/// @throws Error(cannot_write) with the system's reason.
void make_folders(const std::string& path);

/// read_scan() of a file; `file_name` of the result is the path's last part.
/// @throws what read_scan() throws, and Error(cannot_read); messages name the whole path.
Scan read_scan_file(const std::string& path, const Execution& execution);

}  // namespace vitruvian
