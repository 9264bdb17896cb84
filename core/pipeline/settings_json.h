#pragma once

#include <nlohmann/json.hpp>

#include "pipeline/result_json_value.h"
#include "pipeline/settings.h"

namespace vitruvian {

/// `settings` of registration.json: every setting by its name; what was given by hand (alignment, keypoints,
/// start) with its numbers, so that the registration can be run again without the files they came from.
nlohmann::ordered_json settings_to_json(const Settings& settings);

/// What is missing, as in files of earlier versions, or null is as settings_of() the method says.
/// @throws Error(bad_file) naming the place.
Settings settings_from_json(const JsonValue& value);

/// Settings that somebody chose: as settings_from_json(), so that `{"method": "paper"}` is the published
/// pipeline and further members override its stages, as the command line's options do.
/// @throws Error(bad_file) naming the place; also for a name that is none of a setting.
Settings chosen_settings(const JsonValue& value);

/// `parameters` of registration.json: betas, pose, translation_m.
nlohmann::ordered_json parameters_to_json(const BodyParameters& parameters);
/// @throws Error(bad_file) naming the place.
BodyParameters parameters_from_json(const JsonValue& value);

}  // namespace vitruvian
