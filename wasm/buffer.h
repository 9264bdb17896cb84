#pragma once

#include <cstddef>
#include <cstdlib>
#include <span>
#include <utility>

namespace vitruvian::wasm {

/// A file that the page put into our memory; freed with free().
class Buffer {
 public:
  Buffer() = default;
  Buffer(std::byte* data, std::size_t size) : data_(data), size_(size) {}
  Buffer(Buffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~Buffer() { std::free(data_); }

  std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace vitruvian::wasm
