#include "pipeline/body_parameters.h"

#include <algorithm>

#include "base/error.h"

namespace vitruvian {

BodyParameters parameters_of(const BodyModel& body, const BodyState& state) {
  BodyParameters parameters;
  const Index shapes = std::min<Index>(state.betas.size(), body.shape_count());
  parameters.betas = state.betas.head(shapes);
  parameters.pose = state.axis_angle();
  parameters.translation_m = state.translation;
  if (state.betas.size() == body.beta_count()) {
    parameters.expression = state.betas.segment(shapes, body.expression_count);
    parameters.dmpl = state.betas.tail(body.dmpl_count);
  }
  return parameters;
}

BodyState state_of(const BodyModel& body, const BodyParameters& parameters) {
  const Index shapes = parameters.betas.size(), expressions = parameters.expression.size(),
              tissues = parameters.dmpl.size();
  if (parameters.pose.cols() != body.joint_count() || shapes > body.shape_count() ||
      expressions > body.expression_count || tissues > body.dmpl_count) {
    throw Error(ErrorCode::usage, "these parameters are not of the model " + body.name +
                                      ": it has fewer joints, or lacks shape, expression or soft tissue");
  }
  Eigen::VectorXd coefficients = parameters.betas;
  if (expressions + tissues > 0) {
    coefficients = Eigen::VectorXd::Zero(body.beta_count());
    coefficients.head(shapes) = parameters.betas;
    coefficients.segment(body.shape_count(), expressions) = parameters.expression;
    coefficients.segment(body.shape_count() + body.expression_count, tissues) = parameters.dmpl;
  }
  return BodyState::from_axis_angle(parameters.pose, coefficients, parameters.translation_m);
}

}  // namespace vitruvian
