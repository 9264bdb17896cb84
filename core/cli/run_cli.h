#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "base/execution.h"
#include "body/model.h"
#include "cli/arguments.h"
#include "io/scan.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// Exit statuses of contract.md.
enum class ExitStatus {
  ok = 0,
  not_all_ok = 1,
  usage = 2,
  unreadable = 3,
  internal = 4,
  interrupted = 130,
};

/// Registers one scan that took `read_ms` to read.
using RegisterFunction = std::function<Registration(Scan scan, const Settings& settings,
                                                    const Execution& execution, double read_ms)>;
/// Loads models and networks for a run; called once, before any scan is read.
/// @throws Error when they cannot be used.
using RegisterFactory = std::function<RegisterFunction(const RegisterArguments& arguments)>;

/// Loads a body model; an empty name means the default body, or no soft tissue.
/// @throws Error when it cannot be used.
using BodyOpener = std::function<BodyModel(const std::string& model_file, const std::string& dmpl_file)>;

/// What the command line is given by the process that runs it.
struct CliContext {
  std::ostream& out;
  std::ostream& error;
  bool error_is_terminal;
  const Execution& interrupt;  ///< its cancel() ends the run; may be called from a signal handler
  RegisterFactory open_register;
  BodyOpener open_body;
};

/// Runs one command and returns its exit status. Writes to the two streams and below --out; throws nothing.
/// @param arguments  without the program's name.
ExitStatus run_cli(const std::vector<std::string>& arguments, const CliContext& context);

}  // namespace vitruvian
