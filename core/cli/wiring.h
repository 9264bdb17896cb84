#pragma once

#include <string>
#include <vector>

#include "cli/run_cli.h"

namespace vitruvian {

/// The registration of this program: bundled or given models, networks run by OpenCV.
/// @param folders  searched for models and networks, see data_folders().
/// @param cache  folder for what is learnt of users' models (cache_folder()); empty: none.
RegisterFactory native_register(std::vector<std::string> folders, const std::string& cache = {});

/// Body models of this program: the default body from `folders`, or a given file.
BodyOpener native_body(std::vector<std::string> folders);

}  // namespace vitruvian
