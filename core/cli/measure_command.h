#pragma once

#include "cli/run_cli.h"

namespace vitruvian {

/// `vitruvian measure`: writes measurements.json and measurements.csv into --out, or prints the JSON.
ExitStatus run_measure(const MeasureArguments& arguments, const CliContext& context);

}  // namespace vitruvian
