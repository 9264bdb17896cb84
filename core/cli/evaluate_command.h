#pragma once

#include "cli/run_cli.h"

namespace vitruvian {

/// `vitruvian evaluate`: prints the joint errors as JSON. Status 1 when the registration has no joints to
/// compare, 3 when it cannot be read.
/// @throws Error for an unusable truth file.
ExitStatus run_evaluate(const EvaluateArguments& arguments, const CliContext& context);

}  // namespace vitruvian
