#include "base/execution.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace vitruvian {

/// Workers that wait for one job at a time; job k of a round is run by worker k.
struct Execution::Pool {
  explicit Pool(int workers) {
    for (int k = 0; k < workers; ++k) threads.emplace_back([this, k] { run(k); });
  }
  ~Pool() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      stopping = true;
    }
    wake.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  void run(int worker) {
    unsigned seen_round = 0;
    std::unique_lock<std::mutex> lock(mutex);
    for (;;) {
      wake.wait(lock, [&] { return stopping || round != seen_round; });
      if (stopping) return;
      seen_round = round;
      if (worker >= jobs) continue;
      const auto* body = job;
      lock.unlock();
      std::exception_ptr failure;
      try {
        (*body)(worker);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      if (failure && !first_failure) first_failure = failure;
      if (--pending == 0) done.notify_one();
    }
  }

  /// Runs body(0) ... body(count - 1) on the workers and `own` on the calling thread.
  void dispatch(int count, const std::function<void(int)>& body, const std::function<void()>& own) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      job = &body;
      jobs = count;
      pending = count;
      first_failure = nullptr;
      ++round;
    }
    wake.notify_all();
    std::exception_ptr own_failure;
    try {
      own();
    } catch (...) {
      own_failure = std::current_exception();
    }
    std::unique_lock<std::mutex> lock(mutex);
    done.wait(lock, [&] { return pending == 0; });
    if (own_failure) std::rethrow_exception(own_failure);
    if (first_failure) std::rethrow_exception(first_failure);
  }

  std::mutex mutex;
  std::condition_variable wake;
  std::condition_variable done;
  std::vector<std::thread> threads;
  const std::function<void(int)>* job = nullptr;
  int jobs = 0;
  int pending = 0;
  unsigned round = 0;
  bool stopping = false;
  std::exception_ptr first_failure;
};

Execution::Execution(int threads, const Execution* parent) : threads_(std::max(1, threads)), parent_(parent) {
  if (threads_ > 1) pool_ = std::make_unique<Pool>(threads_ - 1);
}

Execution::~Execution() = default;

void Execution::parallel_for(std::ptrdiff_t count, std::ptrdiff_t minimum,
                             const std::function<void(std::ptrdiff_t, std::ptrdiff_t)>& body) const {
  if (count <= 0) return;
  const std::ptrdiff_t wanted = std::max<std::ptrdiff_t>(1, count / std::max<std::ptrdiff_t>(1, minimum));
  const std::ptrdiff_t ranges = std::min<std::ptrdiff_t>(threads_, wanted);
  if (ranges <= 1) {
    body(0, count);
    return;
  }
  const auto bound = [&](std::ptrdiff_t k) { return count * k / ranges; };
  pool_->dispatch(
      static_cast<int>(ranges - 1), [&](int k) { body(bound(k + 1), bound(k + 2)); },
      [&] { body(bound(0), bound(1)); });
}

}  // namespace vitruvian
