#include "task.h"

#include <emscripten.h>

#include <exception>
#include <new>
#include <utility>

namespace vitruvian::wasm {
namespace {

#ifndef __EMSCRIPTEN_PTHREADS__
// Without threads nobody can poll while the work runs: it tells the page itself.
EM_JS(void, tell_progress, (const char* stage, double fraction), {
  if (Module["onProgress"]) Module["onProgress"](UTF8ToString(stage), fraction);
});
EM_JS(void, tell_energy_point, (const char* curve, int iteration, double energy), {
  if (Module["onEnergy"]) Module["onEnergy"](UTF8ToString(curve), iteration, energy);
});
#endif

}  // namespace

Task::Task(int threads) : execution_(threads) {
  execution_.on_progress([this](std::string_view stage, double fraction) {
    std::lock_guard lock(mutex_);
    progress_ = {std::string(stage), fraction};
#ifndef __EMSCRIPTEN_PTHREADS__
    tell_progress(progress_.stage.c_str(), fraction);
#endif
  });
}

void Task::tell_energy(std::string_view curve, int iteration, double energy) {
#ifdef __EMSCRIPTEN_PTHREADS__
  std::lock_guard lock(mutex_);
  energies_.push_back({std::string(curve), iteration, energy});
#else
  tell_energy_point(std::string(curve).c_str(), iteration, energy);
#endif
}

std::vector<EnergyPoint> Task::take_energies() {
  std::lock_guard lock(mutex_);
  return std::exchange(energies_, {});
}

Task::~Task() { stop(); }

void Task::stop() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void Task::require_idle() const {
  if (state() == TaskState::working) throw Error(ErrorCode::internal, "a task is under way");
}

void Task::start(std::function<void()> work) {
  require_idle();
  if (thread_.joinable()) thread_.join();
  execution_.reset_cancel();
  state_ = TaskState::working;
  progress_ = {};
#ifdef __EMSCRIPTEN_PTHREADS__
  thread_ = std::thread([this, work = std::move(work)] { run(work); });
#else
  run(work);
#endif
}

void Task::run(const std::function<void()>& work) noexcept {
  try {
    work();
    finish(TaskState::done, {});
  } catch (const Error& error) {
    finish(TaskState::failed, {std::string(name_of(error.code())), error.what()});
  } catch (const std::bad_alloc&) {
    finish(TaskState::failed, {"out_of_memory", "memory ran out"});
  } catch (const std::exception& error) {
    finish(TaskState::failed, {"internal", error.what()});
  }
}

void Task::finish(TaskState state, TaskError error) {
  std::lock_guard lock(mutex_);
  error_ = std::move(error);
  state_ = state;
}

TaskState Task::state() const {
  std::lock_guard lock(mutex_);
  return state_;
}

TaskProgress Task::progress() const {
  std::lock_guard lock(mutex_);
  return progress_;
}

TaskError Task::error() const {
  std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace vitruvian::wasm
