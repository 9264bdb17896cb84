#pragma once

#include "cli/arguments.h"

namespace vitruvian {

/// Settings with the files read that its options name: --align-file, --keypoints, --regions, --init FILE.
/// @throws Error(bad_file), Error(cannot_read) naming the file and the place in it.
Settings load_edits(const RegisterArguments& arguments);

}  // namespace vitruvian
