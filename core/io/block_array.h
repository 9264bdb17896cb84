#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace vitruvian {

/// An array that grows in blocks: nothing is moved when it grows, its memory stays within one block of what
/// was pushed (whatever count a file announces), and it is given back block by block when the content is
/// taken.
template <class T>
class BlockArray {
 public:
  void push(T value) {
    if (size_ == blocks_.size() * kBlock) blocks_.emplace_back(new T[kBlock]);
    blocks_[size_ / kBlock][size_ % kBlock] = value;
    ++size_;
  }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t index) { return blocks_[index / kBlock][index % kBlock]; }
  const T& operator[](std::size_t index) const { return blocks_[index / kBlock][index % kBlock]; }

  /// Copies everything to `out`, which has room for size() values, and empties the array.
  void take(T* out) {
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      const std::size_t count = std::min(kBlock, size_ - block * kBlock);
      std::copy_n(blocks_[block].get(), count, out + block * kBlock);
      blocks_[block].reset();
    }
    clear();
  }
  /// Gives back the memory of every block that ends at or before `index`; those values must not be used any
  /// more.
  void release_before(std::size_t index) {
    for (; released_ < index / kBlock; ++released_) blocks_[released_].reset();
  }
  void clear() {
    blocks_.clear();
    size_ = released_ = 0;
  }

 private:
  static constexpr std::size_t kBlock = 3 * 16384;  // whole xyz triples
  std::vector<std::unique_ptr<T[]>> blocks_;
  std::size_t size_ = 0;
  std::size_t released_ = 0;
};

}  // namespace vitruvian
