#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/lesson.h"
#include "pipeline/models.h"

namespace vitruvian::wasm {

/// A body posed by hand. Arrays of its description stay valid as long as it does.
struct PosedBody {
  Points3f vertices;    ///< body frame
  Points3d joints;      ///< 3 x J
  double height_m = 0;  ///< standing, of the shape alone
};

/// `{"name", "joints": [{"name", "parent", "low_rad": [3], "high_rad": [3]}], "shape": {gender: {"mean",
/// "deviation"}}, "faces"}`: what there is to move, and how far. Limits of joints that the prior does not
/// know are null.
nlohmann::json describe_body(const Models& models);

/// @param parameters  `{"betas", "pose", "translation_m"}` as in registration.json; missing betas are 0.
/// @throws Error(bad_file) for numbers that the body does not have.
PosedBody pose_body(const BodyModel& body, const std::string& parameters);
/// `{"body", "joints", "height_m"}`.
nlohmann::json describe_posed(const PosedBody& posed);

/// `{"tpose", "keypoint_noise_mm", "one_directional", "prior_weight", "iterations", "seed"}`; what is missing
/// is unchanged. @throws Error(bad_file).
LessonSettings parse_lesson(const std::string& text);
/// `{"steps": [{"stage", "scale_mm", "energy": {...}, "model_to_scan_mm", "scan_to_model_mm", "landmark_mm",
/// "joints", "pairs", "pairs_of_model", "parameters"}], "residual_m", "unchanged_residual_m", "targets":
/// [[3]...], "apart_mm": {"largest", "mean"}}`.
/// @param unchanged  what it is compared with.
nlohmann::json describe_lesson(const Lesson& lesson, const Lesson& unchanged);

}  // namespace vitruvian::wasm
