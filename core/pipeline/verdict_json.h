#pragma once

#include "measure/verdict_features.h"
#include "pipeline/result_json_value.h"

namespace vitruvian {

/// `verdict.features` of registration.json: what the verdict was judged from, by name. `misfit_parts` and
/// `notes` stand among the reasons.
nlohmann::ordered_json features_to_json(const VerdictFeatures& features);

/// The opposite. Members that are missing or null keep their defaults: earlier versions wrote fewer.
/// @throws Error(bad_file) naming file and place.
VerdictFeatures features_from_json(const JsonValue& value);

}  // namespace vitruvian
