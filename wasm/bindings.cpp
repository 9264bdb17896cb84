// Entry points for web/src/worker/core.ts. Text goes out as zero-terminated UTF-8 that stays valid until the
// next call. No exception leaves: a call that fails returns null (or 0) and last_error() tells why.
#include <emscripten.h>
#include <malloc.h>

#include <exception>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/error.h"
#include "session.h"

#ifndef __EMSCRIPTEN_PTHREADS__
#define VITRUVIAN_THREADED 0
#else
#define VITRUVIAN_THREADED 1
#endif

namespace {

// Other threads let the memory grow without this thread's views knowing; naming one here renews them all.
EM_JS(double, renewed_memory_size, (), { return HEAPU8.length; });

using vitruvian::Error;
using vitruvian::ErrorCode;
using vitruvian::wasm::Buffer;
using vitruvian::wasm::EnergyPoint;
using vitruvian::wasm::ModelPart;
using vitruvian::wasm::Session;
using vitruvian::wasm::Task;
using vitruvian::wasm::TaskError;
using vitruvian::wasm::TaskProgress;

// The module is the session: one worker, one scan.
std::unique_ptr<Session> session;
std::string text;
TaskError failure;

std::string json_of(const TaskError& error) {
  const nlohmann::json json = {{"code", error.code}, {"message", error.message}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Runs `call`; what it throws becomes the failure, and `otherwise` the result.
template <typename Call, typename Result>
Result guarded(const Call& call, Result otherwise) noexcept {
  try {
    return call();
  } catch (const Error& error) {
    failure = {std::string(name_of(error.code())), error.what()};
  } catch (const std::bad_alloc&) {
    failure = {"out_of_memory", "memory ran out"};
  } catch (const std::exception& error) {
    failure = {"internal", error.what()};
  }
  return otherwise;
}

Session& open_session() {
  if (!session) throw Error(ErrorCode::internal, "the session was not created");
  return *session;
}

const char* kept(std::string value) {
  text = std::move(value);
  return text.c_str();
}

const char* const kNoText = nullptr;

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* vitruvian_version() { return VITRUVIAN_VERSION; }

/// Bytes of the module's memory. Makes Module.HEAPU8 cover all of it.
EMSCRIPTEN_KEEPALIVE double vitruvian_memory() { return renewed_memory_size(); }

/// Bytes of that memory in use; the rest is free for what comes.
EMSCRIPTEN_KEEPALIVE double vitruvian_memory_in_use() { return static_cast<double>(mallinfo().uordblks); }

EMSCRIPTEN_KEEPALIVE int vitruvian_has_threads() { return VITRUVIAN_THREADED; }

EMSCRIPTEN_KEEPALIVE const char* vitruvian_last_error() { return kept(json_of(failure)); }

EMSCRIPTEN_KEEPALIVE int vitruvian_create(int threads) {
  return guarded(
      [&] {
        session = std::make_unique<Session>(VITRUVIAN_THREADED ? threads : 1);
        return 1;
      },
      0);
}

/// Takes `data` (from malloc) over.
EMSCRIPTEN_KEEPALIVE int vitruvian_open(std::byte* data, std::size_t size, const char* name) {
  Buffer buffer(data, size);
  return guarded(
      [&] {
        open_session().open(std::move(buffer), name);
        return 1;
      },
      0);
}

/// TaskState of the task started last.
EMSCRIPTEN_KEEPALIVE int vitruvian_task_state() {
  return session ? static_cast<int>(session->task().state()) : 0;
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_task_progress() {
  return guarded(
      [&] {
        Task& task = open_session().task();
        const TaskProgress progress = task.progress();
        nlohmann::json energies = nlohmann::json::array();
        for (const EnergyPoint& point : task.take_energies())
          energies.push_back(
              {{"curve", point.curve}, {"iteration", point.iteration}, {"value", point.energy}});
        const nlohmann::json json = {
            {"stage", progress.stage}, {"fraction", progress.fraction}, {"energies", energies}};
        return kept(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
      },
      kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_task_error() {
  return guarded([&] { return kept(json_of(open_session().task().error())); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE void vitruvian_cancel() {
  if (session) session->task().cancel();
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_scan_report() {
  return guarded([&] { return kept(open_session().scan_report()); }, kNoText);
}

/// Takes `data` (from malloc) over. @param part  a ModelPart.
EMSCRIPTEN_KEEPALIVE int vitruvian_load_model(int part, std::byte* data, std::size_t size, const char* name) {
  const Buffer buffer(data, size);
  return guarded(
      [&] {
        open_session().models().load(static_cast<ModelPart>(part), buffer, name);
        return 1;
      },
      0);
}

/// Takes `data` (from malloc), a user's model file, over. @return 1 + its ModelFileKind; 0: failed.
EMSCRIPTEN_KEEPALIVE int vitruvian_add_model(std::byte* data, std::size_t size, const char* name) {
  Buffer buffer(data, size);
  return guarded([&] { return 1 + static_cast<int>(open_session().models().add(std::move(buffer), name)); },
                 0);
}

/// Puts the files that were added to use; with none, the bundled models. @param known  see
/// ModelShelf::begin().
EMSCRIPTEN_KEEPALIVE int vitruvian_use_models(const char* known) {
  return guarded(
      [&] {
        open_session().use_models(known);
        return 1;
      },
      0);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_model_report() {
  return guarded([&] { return kept(open_session().models().report()); }, kNoText);
}

/// @return 1 + the number of stages that still hold; 0: failed.
EMSCRIPTEN_KEEPALIVE int vitruvian_configure(const char* settings) {
  return guarded([&] { return 1 + open_session().configure(settings); }, 0);
}

/// @param until  a PipelineStage.
EMSCRIPTEN_KEEPALIVE int vitruvian_begin(int until, int again) {
  return guarded(
      [&] {
        open_session().begin(until, again != 0);
        return 1;
      },
      0);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_request_report() {
  return guarded([&] { return kept(open_session().request_report()); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE float* vitruvian_reply_buffer(std::size_t input, std::size_t output, std::size_t size) {
  return guarded([&] { return open_session().reply_buffer(input, output, size); },
                 static_cast<float*>(nullptr));
}

EMSCRIPTEN_KEEPALIVE int vitruvian_resume() {
  return guarded(
      [&] {
        open_session().resume();
        return 1;
      },
      0);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_findings_report() {
  return guarded([&] { return kept(open_session().findings_report()); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_edit(const char* request) {
  return guarded([&] { return kept(open_session().edit(request)); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_files_report(const char* mesh_format) {
  return guarded([&] { return kept(open_session().files_report(mesh_format)); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_measurements_report() {
  return guarded([&] { return kept(open_session().measurements_report()); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_profile_report(const char* segment, int count) {
  return guarded([&] { return kept(open_session().profile_report(segment, count)); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_measured_files_report(const char* format) {
  return guarded([&] { return kept(open_session().measured_files_report(format)); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_body_report() {
  return guarded([&] { return kept(open_session().body_report()); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_pose_body(const char* parameters) {
  return guarded([&] { return kept(open_session().pose_body(parameters)); }, kNoText);
}

EMSCRIPTEN_KEEPALIVE int vitruvian_begin_lesson(const char* settings) {
  return guarded(
      [&] {
        open_session().begin_lesson(settings);
        return 1;
      },
      0);
}

EMSCRIPTEN_KEEPALIVE const char* vitruvian_lesson_report() {
  return guarded([&] { return kept(open_session().lesson_report()); }, kNoText);
}

}  // extern "C"
