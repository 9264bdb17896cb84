#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string_view>

#include "base/error.h"

namespace vitruvian {

/// Threads, progress and cancel for one piece of work. Handed down by reference; there is no global pool.
///
/// `cancel()` and `cancelled()` may be called from any thread; everything else from the thread that owns the
/// work.
class Execution {
 public:
  using ProgressCallback = std::function<void(std::string_view stage, double fraction)>;

  /// @param threads  number of threads that work in parallel, the calling one included; at least 1.
  /// @param parent   larger piece of work that this one is part of: its cancel counts here too. Must outlive
  /// this.
  explicit Execution(int threads = 1, const Execution* parent = nullptr);
  ~Execution();
  Execution(const Execution&) = delete;
  Execution& operator=(const Execution&) = delete;

  int threads() const noexcept { return threads_; }

  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  void reset_cancel() noexcept { cancelled_.store(false, std::memory_order_relaxed); }
  bool cancelled() const noexcept {
    return cancelled_.load(std::memory_order_relaxed) || (parent_ && parent_->cancelled());
  }
  /// Throws Error(cancelled) when cancel() was called. Long loops call this at least every 50 ms.
  void check() const {
    if (cancelled()) throw Error(ErrorCode::cancelled, "cancelled");
  }

  void on_progress(ProgressCallback callback) { progress_ = std::move(callback); }
  /// Reports that `fraction` (0..1) of `stage` is done.
  void progress(std::string_view stage, double fraction) const {
    if (progress_) progress_(stage, fraction);
  }

  /// Splits [0, count) into at most threads() contiguous ranges and calls `body(begin, end)` for each, in
  /// parallel. Ranges depend only on `count`, `minimum` and threads(), so results reduced in range order are
  /// reproducible. An exception from any range is rethrown here after all have ended. Not re-entrant: body
  /// must not call it again.
  /// @param minimum  smallest range worth a thread of its own.
  void parallel_for(std::ptrdiff_t count, std::ptrdiff_t minimum,
                    const std::function<void(std::ptrdiff_t begin, std::ptrdiff_t end)>& body) const;

 private:
  struct Pool;
  int threads_;
  const Execution* parent_;
  std::unique_ptr<Pool> pool_;
  std::atomic<bool> cancelled_{false};
  ProgressCallback progress_;
};

}  // namespace vitruvian
