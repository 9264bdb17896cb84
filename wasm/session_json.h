#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "geometry/mesh.h"
#include "io/scan.h"
#include "keypoints/network.h"
#include "pipeline/landmark_stage.h"
#include "pipeline/pipeline.h"
#include "pipeline/settings.h"

namespace vitruvian::wasm {

/// `[address, number of elements]` of an array in the module's memory.
nlohmann::json array_reference(const void* data, std::ptrdiff_t elements);

nlohmann::json describe_scan(const Scan& scan, const DecimatedMesh& shown);
nlohmann::json describe_request(const NetworkRequest& request);
/// The pictures and the landmarks in them: `[{"width", "height", "rgb", "landmarks": [{"x", "y",
/// "confidence"}]}]`.
nlohmann::json describe_views(const LandmarkStage& stage);

/// `{"unit", "metres_per_unit", "up", "front", "front_is_known", "method", "body_from_scan", "height_m",
/// "note"}`.
nlohmann::json describe_alignment(const RegistrationPipeline::AlignFinding& finding);
/// As in registration.json.
nlohmann::json describe_keypoints(const std::vector<Keypoint>& keypoints);
/// `[{"name", "body_m", "turn_rad"}]`: position, and rotation against the parent (its angle).
nlohmann::json describe_joints(const BodyModel& body, const BodyState& state);

/// chosen_settings() of a text. @throws Error(usage) naming what is wrong.
Settings parse_settings(const std::string& text);

std::string text_of(const nlohmann::json& json);

}  // namespace vitruvian::wasm
