#include "io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#ifndef __EMSCRIPTEN__
#include <sys/mman.h>
#endif

#include "base/error.h"

namespace vitruvian {
namespace {

[[noreturn]] void cannot_read(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::cannot_read, path + ": cannot be read: " + why);
}

[[noreturn]] void cannot_write(const std::string& path, int error) {
  throw Error(ErrorCode::cannot_write, path + ": cannot be written: " + std::strerror(error));
}

/// A file descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }
  /// Closes now; 0, or the error's number.
  int close() { return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno; }

 private:
  int descriptor_;
};

/// Writes everything; 0, or the error's number.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t count = ::write(descriptor, content.data(), std::min<std::size_t>(content.size(), 1 << 30));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count < 0 ? errno : EIO;
    content.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

/// Creates a file beside `path` under a name that does not exist yet.
int open_temporary(const std::string& path, std::string& temporary) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary = path + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".part";
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

}  // namespace

FileBytes::FileBytes(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) cannot_read(path, std::strerror(errno));
  struct stat status;
  if (::fstat(file.get(), &status) != 0) cannot_read(path, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) cannot_read(path, "it is a folder; give the scan files inside it");
  if (!S_ISREG(status.st_mode)) cannot_read(path, "it is not a regular file");
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) return;
#ifndef __EMSCRIPTEN__
  void* address = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.get(), 0);
  if (address != MAP_FAILED) {
    ::madvise(address, size_, MADV_SEQUENTIAL);
    data_ = static_cast<std::byte*>(address);
    mapped_ = true;
    return;
  }
#endif
  std::unique_ptr<std::byte[]> buffer(new std::byte[size_]);
  for (std::size_t done = 0; done < size_;) {
    const ssize_t count =
        ::read(file.get(), buffer.get() + done, std::min<std::size_t>(size_ - done, 1 << 30));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) cannot_read(path, std::strerror(errno));
    if (count == 0) cannot_read(path, "it became shorter while it was read");
    done += static_cast<std::size_t>(count);
  }
  data_ = buffer.release();
}

FileBytes::~FileBytes() { release(); }

FileBytes::FileBytes(FileBytes&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      mapped_(std::exchange(other.mapped_, false)) {}

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  if (this != &other) {
    release();
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
    mapped_ = std::exchange(other.mapped_, false);
  }
  return *this;
}

void FileBytes::release() noexcept {
#ifndef __EMSCRIPTEN__
  if (mapped_) {
    ::munmap(data_, size_);
    return;
  }
#endif
  delete[] data_;
}

void write_file(const std::string& path, std::string_view content) {
  std::string temporary;
  Descriptor file(open_temporary(path, temporary));
  if (file.get() < 0) cannot_write(path, errno);
  int error = write_all(file.get(), content);
  const int close_error = file.close();
  if (error == 0) error = close_error;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    cannot_write(path, error);
  }
}

void make_folders(const std::string& path) {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    struct stat status;
    const bool is_folder = ::stat(part.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
    // Another process may make the folder between the two calls.
    if (!is_folder && ::mkdir(part.c_str(), 0777) != 0 &&
        !(errno == EEXIST && ::stat(part.c_str(), &status) == 0 && S_ISDIR(status.st_mode))) {
      cannot_write(path, errno);
    }
    if (end == std::string::npos) return;
  }
}

Scan read_scan_file(const std::string& path, const Execution& execution) {
  const FileBytes file(path);
  Scan scan = read_scan(file.bytes(), path, execution);
  scan.file_name = path.substr(path.find_last_of('/') + 1);
  return scan;
}

}  // namespace vitruvian
