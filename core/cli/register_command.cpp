#include "cli/register_command.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>

#include "cli/edits.h"
#include "cli/paths.h"
#include "cli/progress.h"
#include "cli/table.h"
#include "io/file.h"
#include "io/mesh_writer.h"
#include "pipeline/report.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// What became of one scan.
struct Outcome {
  std::string scan;  ///< as given
  std::optional<Registration> registration;
  std::string error;  ///< empty when there is a registration
  ExitStatus status = ExitStatus::ok;
};

std::string fixed(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

ExitStatus status_of(const Error& error) {
  switch (error.code()) {
    case ErrorCode::unsupported_format:
    case ErrorCode::bad_file:
    case ErrorCode::no_geometry:
    case ErrorCode::cannot_read:
      return ExitStatus::unreadable;
    default:
      return ExitStatus::internal;
  }
}

std::string mesh_bytes(const Registration& registration, MeshFormat format) {
  MeshView mesh{registration.registered_vertices, registration.registered_faces};
  mesh.values = registration.vertex_error_mm;
  mesh.value_name = "error_mm";
  switch (format) {
    case MeshFormat::ply:
      return to_ply(mesh);
    case MeshFormat::obj:
      return to_obj(mesh);
    case MeshFormat::glb:
      return to_glb(mesh, registration.alignment.body_from_scan);
  }
  throw Error(ErrorCode::internal, "unknown mesh format");
}

/// Writes a registration into its folder, registration.json last, and removes what does not belong to it.
void write_outputs(Registration& registration, const std::string& folder, MeshFormat format) {
  const Clock::time_point begin = Clock::now();
  const auto path = [&](const std::string& name) { return (std::filesystem::path(folder) / name).string(); };
  const bool has_mesh =
      registration.verdict.status != VerdictStatus::failed && registration.registered_vertices.cols() > 0;
  std::vector<std::string> kept = {"registration.json"};
  std::string mesh;
  if (has_mesh) {
    mesh = mesh_bytes(registration, format);
    kept.push_back(registered_mesh_name(format));
    if (registration.surface_error) kept.emplace_back("errors.csv");
    if (registration.offsets.cols() > 0) kept.emplace_back(kOffsetsFile);
  }
  make_folders(folder);
  remove_stale_outputs(folder, kept);
  if (has_mesh) {
    write_file(path(registered_mesh_name(format)), mesh);
    if (registration.surface_error) write_file(path("errors.csv"), errors_csv(*registration.surface_error));
    if (registration.offsets.cols() > 0) write_file(path(kOffsetsFile), offsets_npz(registration.offsets));
  }
  registration.timing_ms.write = milliseconds_since(begin);
  registration.timing_ms.total += registration.timing_ms.write;
  write_file(path("registration.json"),
             registration_json(registration, VITRUVIAN_VERSION, JsonStyle::pretty));
}

std::string summary(const Outcome& outcome) {
  if (!outcome.registration) return "error: " + outcome.error;
  const Registration& r = *outcome.registration;
  std::string line = to_string(r.verdict.status) + ", confidence " + fixed(r.verdict.confidence, 2);
  if (r.surface_error && r.surface_error->surface_all.count > 0) {
    line += ", mean error " + fixed(r.surface_error->surface_all.mean_mm, 1) + " mm";
  }
  return line + ", " + fixed(r.timing_ms.total / 1e3, 1) + " s";
}

std::string batch_table(const std::vector<Outcome>& outcomes) {
  std::vector<std::vector<std::string>> rows = {
      {"scan", "verdict", "confidence", "mean mm", "p95 mm", "scan p95 mm", "s", "remark"}};
  for (const Outcome& outcome : outcomes) {
    const std::string name = printable(outcome.scan);
    if (!outcome.registration) {
      rows.push_back({name, "error", "", "", "", "", "", printable(outcome.error)});
      continue;
    }
    const Registration& r = *outcome.registration;
    std::vector<std::string> row = {name, to_string(r.verdict.status), fixed(r.verdict.confidence, 2)};
    if (r.surface_error) {
      const DistanceStatistics &surface = r.surface_error->surface_all,
                               &scan = r.surface_error->scan_to_model;
      row.push_back(surface.count > 0 ? fixed(surface.mean_mm, 1) : "");
      row.push_back(surface.count > 0 ? fixed(surface.p95_mm, 1) : "");
      row.push_back(scan.count > 0 ? fixed(scan.p95_mm, 1) : "");
    } else {
      row.insert(row.end(), 3, "");
    }
    row.push_back(fixed(r.timing_ms.total / 1e3, 1));
    row.push_back(r.verdict.reasons.empty() ? "" : r.verdict.reasons.front());
    rows.push_back(std::move(row));
  }
  return text_table(rows);
}

/// One run of the command.
class RegisterRun {
 public:
  RegisterRun(const RegisterArguments& arguments, const CliContext& context)
      : arguments_(arguments),
        context_(context),
        settings_(with_threads(arguments.settings)),
        execution_(settings_.threads, &context.interrupt),
        progress_(context.error, style(), static_cast<int>(arguments.scans.size())) {
    execution_.on_progress(
        [this](std::string_view stage, double fraction) { progress_.update(stage, fraction); });
  }

  ExitStatus run(const std::vector<std::string>& folders, const RegisterFunction& register_scan) {
    for (std::size_t k = 0; k < folders.size(); ++k) {
      execution_.check();
      progress_.begin_scan(static_cast<int>(k + 1), arguments_.scans[k]);
      outcomes_.push_back(process(arguments_.scans[k], folders[k], register_scan));
      report(outcomes_.back(), folders[k]);
    }
    if (outcomes_.size() > 1 && !arguments_.quiet) {
      (arguments_.json ? context_.error : context_.out) << batch_table(outcomes_);
    }
    ExitStatus worst = ExitStatus::ok;
    for (const Outcome& outcome : outcomes_) worst = std::max(worst, outcome.status);
    return worst;
  }

 private:
  static Settings with_threads(Settings settings) {
    if (settings.threads == 0)
      settings.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return settings;
  }

  ProgressStyle style() const {
    if (arguments_.quiet) return ProgressStyle::none;
    return context_.error_is_terminal ? ProgressStyle::bar : ProgressStyle::lines;
  }

  Outcome process(const std::string& scan_path, const std::string& folder,
                  const RegisterFunction& register_scan) {
    Outcome outcome;
    outcome.scan = scan_path;
    std::string code;
    try {
      const Clock::time_point begin = Clock::now();
      execution_.progress("read", 0);
      Scan scan = read_scan_file(scan_path, execution_);
      if (arguments_.project) check_scan(*arguments_.project, scan);
      Registration registration =
          register_scan(std::move(scan), settings_, execution_, milliseconds_since(begin));
      // Last chance to stop: from here on the files are written without a pause.
      execution_.check();
      execution_.progress("write", 0);
      write_outputs(registration, folder, arguments_.format);
      outcome.status =
          registration.verdict.status == VerdictStatus::ok ? ExitStatus::ok : ExitStatus::not_all_ok;
      outcome.registration = std::move(registration);
      return outcome;
    } catch (const Error& error) {
      // These are about the run as a whole and would come back with every scan.
      if (error.code() == ErrorCode::cancelled || error.code() == ErrorCode::usage ||
          error.code() == ErrorCode::not_available) {
        throw;
      }
      outcome.status = status_of(error);
      outcome.error = error.what();
      code = name_of(error.code());
    } catch (const std::exception& error) {
      outcome.status = ExitStatus::internal;
      outcome.error = scan_path + ": internal error: " + error.what();
      code = name_of(ErrorCode::internal);
    }
    discard_earlier(folder);
    if (arguments_.json) context_.out << error_json(scan_path, code, outcome.error) << "\n" << std::flush;
    return outcome;
  }

  /// A scan without a result must not keep that of an earlier run. Where that cannot be done, writing had
  /// failed too.
  static void discard_earlier(const std::string& folder) {
    try {
      remove_stale_outputs(folder, {});
    } catch (const Error&) {
    }
  }

  void report(Outcome& outcome, const std::string& folder) {
    progress_.end_scan(printable(summary(outcome)));
    if (!outcome.registration) {
      if (arguments_.quiet) context_.error << "vitruvian: " << printable(outcome.error) << "\n";
      return;
    }
    Registration& registration = *outcome.registration;
    if (arguments_.json) {
      context_.out << registration_json(registration, VITRUVIAN_VERSION, JsonStyle::compact) << "\n"
                   << std::flush;
    } else if (!arguments_.quiet && arguments_.scans.size() == 1) {
      context_.out << report_text(registration) << "Written  " << printable(folder) << "\n";
    }
    // The table needs the numbers only.
    registration.registered_vertices.resize(3, 0);
    registration.registered_faces.resize(3, 0);
    registration.vertex_error_mm = {};
    registration.offsets.resize(3, 0);
  }

  const RegisterArguments& arguments_;
  const CliContext& context_;
  Settings settings_;
  Execution execution_;
  Progress progress_;
  std::vector<Outcome> outcomes_;
};

}  // namespace

ExitStatus run_register(const RegisterArguments& arguments, const CliContext& context) {
  const std::vector<std::string> folders = output_folders(arguments.scans, arguments.out);
  const RegisterArguments loaded = load_edits(arguments);
  const RegisterFunction register_scan = context.open_register(loaded);
  make_folders(loaded.out);
  return RegisterRun(loaded, context).run(folders, register_scan);
}

}  // namespace vitruvian
