#include "teaching_json.h"

#include <Eigen/LU>

#include "base/error.h"
#include "pipeline/body_parameters.h"
#include "pipeline/outcome.h"
#include "pipeline/result_json_value.h"
#include "pipeline/settings_json.h"
#include "session_json.h"

namespace vitruvian::wasm {
namespace {

nlohmann::json list_of(const Eigen::VectorXd& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

}  // namespace

nlohmann::json describe_body(const Models& models) {
  const BodyModel& body = models.body;
  if (body.joint_count() == 0) throw Error(ErrorCode::internal, "no body model is loaded");
  nlohmann::json joints = nlohmann::json::array();
  for (int j = 0; j < body.joint_count(); ++j) {
    nlohmann::json joint = {{"name", body.joint_names[j]}, {"parent", body.parent[j]}};
    if (j > 0 && 3 * j <= models.prior.limit_low.size()) {
      joint["low_rad"] = list_of(models.prior.limit_low.segment<3>(3 * (j - 1)));
      joint["high_rad"] = list_of(models.prior.limit_high.segment<3>(3 * (j - 1)));
    } else {
      joint["low_rad"] = joint["high_rad"] = nullptr;
    }
    joints.push_back(std::move(joint));
  }
  nlohmann::json shape;
  for (const Gender gender : {Gender::neutral, Gender::female, Gender::male}) {
    const ShapePrior& prior = body.prior(gender);
    const Eigen::MatrixXd covariance = prior.precision.inverse();
    shape[std::string(name_of(gender))] = {
        {"mean", list_of(prior.mean)},
        {"deviation", list_of(covariance.diagonal().cwiseMax(0.0).cwiseSqrt())}};
  }
  return {{"name", body.name},
          {"joints", joints},
          {"shape", shape},
          {"faces", array_reference(body.faces.data(), body.faces.size())}};
}

PosedBody pose_body(const BodyModel& body, const std::string& parameters) {
  const nlohmann::json json = parse_json(parameters, "body");
  const BodyParameters given = parameters_from_json(JsonValue(json, "body", ""));
  if (given.pose.cols() != body.joint_count() || given.betas.size() > body.beta_count()) {
    throw Error(ErrorCode::bad_file, "body: it has " + std::to_string(body.joint_count()) + " joints and " +
                                         std::to_string(body.beta_count()) + " shape components");
  }
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(body.beta_count());
  betas.head(given.betas.size()) = given.betas;
  const BodyState state = BodyState::from_axis_angle(given.pose, betas, given.translation_m);
  return {posed_vertices<float>(body, state), pose_skeleton(body, state).joints,
          standing_stature(body, betas)};
}

nlohmann::json describe_posed(const PosedBody& posed) {
  nlohmann::json joints = nlohmann::json::array();
  for (Index j = 0; j < posed.joints.cols(); ++j) joints.push_back(list_of(posed.joints.col(j)));
  return {{"body", array_reference(posed.vertices.data(), posed.vertices.size())},
          {"joints", joints},
          {"height_m", posed.height_m}};
}

LessonSettings parse_lesson(const std::string& text) {
  const nlohmann::json json = parse_json(text, "lesson");
  const JsonValue value(json, "lesson", "");
  LessonSettings settings;
  if (value.has("tpose")) settings.tpose = value.at("tpose").truth();
  if (value.has("keypoint_noise_mm"))
    settings.keypoint_noise_m = value.at("keypoint_noise_mm").number() / 1000;
  if (value.has("one_directional")) settings.one_directional = value.at("one_directional").truth();
  if (value.has("prior_weight")) settings.prior_weight = value.at("prior_weight").number();
  if (value.has("iterations")) settings.iterations = static_cast<int>(value.at("iterations").whole(1, 1000));
  if (value.has("seed")) settings.seed = static_cast<std::uint32_t>(value.at("seed").whole(0, 1'000'000));
  return settings;
}

nlohmann::json describe_lesson(const Lesson& lesson, const Lesson& unchanged) {
  nlohmann::json steps = nlohmann::json::array();
  for (const TraceStep& step : lesson.steps) {
    const Points3d pose = step.state.axis_angle();
    steps.push_back({{"stage", step.stage},
                     {"scale_mm", 1000 * step.scale},
                     {"energy",
                      {{"model_to_scan", step.energy.model_to_scan},
                       {"scan_to_model", step.energy.scan_to_model},
                       {"landmarks", step.energy.landmarks},
                       {"pose_prior", step.energy.pose_prior},
                       {"joint_limits", step.energy.joint_limits},
                       {"shape_prior", step.energy.shape_prior}}},
                     {"model_to_scan_mm", 1000 * step.model_to_scan_m},
                     {"scan_to_model_mm", 1000 * step.scan_to_model_m},
                     {"landmark_mm", 1000 * step.landmark_m},
                     {"joints", array_reference(step.joints.data(), step.joints.size())},
                     {"pairs", array_reference(step.pairs.data(), step.pairs.size())},
                     {"pairs_of_model", step.pairs_of_model},
                     {"parameters",
                      {{"betas", list_of(step.state.betas)},
                       {"pose", list_of(Eigen::Map<const Eigen::VectorXd>(pose.data(), pose.size()))},
                       {"translation_m", list_of(step.state.translation)}}}});
  }
  nlohmann::json targets = nlohmann::json::array();
  for (const LandmarkTarget& l : lesson.targets) {
    if (l.weight > 0) targets.push_back(list_of(l.target));
  }
  const auto floats = [](const std::vector<float>& values) {
    return array_reference(values.data(), static_cast<std::ptrdiff_t>(values.size()));
  };
  const JointsApart apart = joints_apart(lesson, unchanged);
  return {{"steps", steps},
          {"residual_m", floats(lesson.residual_m)},
          {"unchanged_residual_m", floats(unchanged.residual_m)},
          {"targets", targets},
          {"apart_mm", {{"largest", 1000 * apart.largest_m}, {"mean", 1000 * apart.mean_m}}}};
}

}  // namespace vitruvian::wasm
