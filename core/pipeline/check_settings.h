#pragma once

#include "pipeline/models.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// Refuses settings that contradict each other or the models, before any work.
/// @throws Error(usage) naming the option, what is wrong and the mend; Error(not_available).
void check_settings(const Settings& settings, const Models& models);

}  // namespace vitruvian
