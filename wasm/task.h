#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/execution.h"

namespace vitruvian::wasm {

/// Values are known to web/src/worker/core.ts.
enum class TaskState { idle = 0, working = 1, done = 2, failed = 3 };

struct TaskProgress {
  std::string stage;
  double fraction = -1;  ///< below 0: unknown
};

/// An iteration of the published solver.
struct EnergyPoint {
  std::string curve;
  int iteration;
  double energy;
};

struct TaskError {
  std::string code, message;
};

/// One piece of work at a time, on a thread of its own where the build has threads, so that the worker's
/// event loop stays free to receive a cancel. Without threads start() works in the caller.
class Task {
 public:
  explicit Task(int threads);
  ~Task();

  const Execution& execution() const { return execution_; }
  /// Keeps an iteration's energy for take_energies(), or tells the page where there are no threads. From the
  /// working thread.
  void tell_energy(std::string_view curve, int iteration, double energy);
  /// What was told since the last call.
  std::vector<EnergyPoint> take_energies();

  /// @param work  may throw; an Error(cancelled) leaves the state `failed`.
  /// @throws Error(internal) while another task works.
  void start(std::function<void()> work);
  void cancel() noexcept { execution_.cancel(); }
  /// Cancels and waits; nothing may be started afterwards.
  void stop();
  /// @throws Error(internal) while a task works.
  void require_idle() const;

  TaskState state() const;
  TaskProgress progress() const;
  TaskError error() const;  ///< of the last task that failed

 private:
  void run(const std::function<void()>& work) noexcept;
  void finish(TaskState state, TaskError error);

  Execution execution_;
  mutable std::mutex mutex_;
  TaskState state_ = TaskState::idle;
  TaskProgress progress_;
  std::vector<EnergyPoint> energies_;
  TaskError error_;
  std::thread thread_;
};

}  // namespace vitruvian::wasm
