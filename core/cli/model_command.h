#pragma once

#include "cli/run_cli.h"

namespace vitruvian {

/// `vitruvian model info`: prints what a body model file holds. Status 3 when it cannot be used.
ExitStatus run_model_info(const ModelInfoArguments& arguments, const CliContext& context);

}  // namespace vitruvian
