#pragma once

#include "cli/run_cli.h"

namespace vitruvian {

/// `vitruvian register`: registers each scan into its folder below --out.
/// @throws Error(usage or not_available, or what the factory throws) before any scan is read,
/// Error(cannot_write) when the output folder cannot be made; what goes wrong with a single scan is reported
/// and counted.
ExitStatus run_register(const RegisterArguments& arguments, const CliContext& context);

}  // namespace vitruvian
