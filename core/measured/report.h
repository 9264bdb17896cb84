#pragma once

#include <string>

#include "measured/measured_registration.h"

namespace vitruvian {

/// report.html: the standing and the sitting body with what was measured on them, profiles along limbs and
/// trunk, and every dimension and segment with its definition. See to_html_report().
std::string measured_report(const MeasuredRegistration& measured);

}  // namespace vitruvian
