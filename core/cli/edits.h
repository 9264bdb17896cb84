#pragma once

#include "cli/arguments.h"

namespace vitruvian {

/// The arguments with the files read that its options name: --align-file, --keypoints, --regions, --crop,
/// --init FILE, --project.
/// @throws Error(bad_file), Error(cannot_read) naming the file and the place in it; Error(usage) when a
/// project is given beside options that it holds itself, or with several scans.
RegisterArguments load_edits(const RegisterArguments& arguments);

}  // namespace vitruvian
