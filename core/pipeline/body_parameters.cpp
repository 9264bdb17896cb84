#include "pipeline/body_parameters.h"

#include <algorithm>

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

BodyState state_of(const BodyParameters& parameters) {
  const Index shapes = parameters.betas.size(), expressions = parameters.expression.size();
  Eigen::VectorXd coefficients(shapes + expressions + parameters.dmpl.size());
  coefficients.head(shapes) = parameters.betas;
  coefficients.segment(shapes, expressions) = parameters.expression;
  coefficients.tail(parameters.dmpl.size()) = parameters.dmpl;
  return BodyState::from_axis_angle(parameters.pose, coefficients, parameters.translation_m);
}

}  // namespace vitruvian
