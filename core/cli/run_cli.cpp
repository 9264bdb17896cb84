#include "cli/run_cli.h"

#include <exception>

#include "cli/evaluate_command.h"
#include "cli/measure_command.h"
#include "cli/model_command.h"
#include "cli/register_command.h"

namespace vitruvian {
namespace {

struct Dispatch {
  const CliContext& context;

  ExitStatus operator()(const PrintArguments& arguments) const {
    context.out << arguments.text;
    return ExitStatus::ok;
  }
  ExitStatus operator()(const RegisterArguments& arguments) const { return run_register(arguments, context); }
  ExitStatus operator()(const MeasureArguments& arguments) const { return run_measure(arguments, context); }
  ExitStatus operator()(const EvaluateArguments& arguments) const { return run_evaluate(arguments, context); }
  ExitStatus operator()(const ModelInfoArguments& arguments) const {
    return run_model_info(arguments, context);
  }
};

}  // namespace

ExitStatus run_cli(const std::vector<std::string>& arguments, const CliContext& context) {
  try {
    const ExitStatus status = std::visit(Dispatch{context}, parse_arguments(arguments));
    context.out.flush();
    if (context.out.good()) return status;
    context.error << "vitruvian: standard output cannot be written\n";
    return ExitStatus::internal;
  } catch (const Error& error) {
    const bool interrupted = error.code() == ErrorCode::cancelled;
    context.error << "vitruvian: " << (interrupted ? "interrupted" : error.what()) << "\n";
    switch (error.code()) {
      case ErrorCode::cancelled:
        return ExitStatus::interrupted;
      case ErrorCode::cannot_write:
      case ErrorCode::internal:
        return ExitStatus::internal;
      default:
        return ExitStatus::usage;
    }
  } catch (const std::exception& error) {
    context.error << "vitruvian: internal error: " << error.what() << "\n";
    return ExitStatus::internal;
  }
}

}  // namespace vitruvian
