#include "anthropometry/uncertainty.h"

#include <gtest/gtest.h>

#include <string>

#include "anthropometry/dimension_errors.h"
#include "core/anthropometry/measured_body.h"

namespace vitruvian {
namespace {

TEST(DimensionErrors, AreSortedPlausibleAndOfDimensionsThatExist) {
  std::string_view previous;
  for (const DimensionError& each : dimension_errors()) {
    EXPECT_LT(previous, each.id) << "the table is sorted, no id twice";
    previous = each.id;
    for (const DimensionError::Size& size : {each.parametric, each.refined}) {
      EXPECT_GT(size.rms_mm, 0.1) << each.id << ": no registration is that good";
      EXPECT_LT(size.rms_mm, 60) << each.id;
      EXPECT_GT(size.fit_mm, 0) << each.id;
    }
  }
  EXPECT_GT(dimension_errors().size(), 60u);
  for (const DimensionSpec& spec : dimension_specs()) {
    EXPECT_TRUE(known_uncertainty(spec.id, false, 0.001)) << spec.id << " was compared with no truth";
  }
}

TEST(Uncertainty, IsTheMeasuredErrorAndGrowsOnlyBeyondTheFitItWasMeasuredWith) {
  for (const DimensionError& each : dimension_errors()) {
    for (const bool refined : {false, true}) {
      const DimensionError::Size& size = refined ? each.refined : each.parametric;
      const double fit = 1e-3 * size.fit_mm, rms = 1e-3 * size.rms_mm;
      EXPECT_DOUBLE_EQ(*known_uncertainty(each.id, refined, 0.5 * fit), rms) << each.id;
      EXPECT_DOUBLE_EQ(*known_uncertainty(each.id, refined, fit), rms) << each.id;
      EXPECT_NEAR(*known_uncertainty(each.id, refined, 3 * fit), 3 * rms, 1e-12) << each.id;
      EXPECT_FALSE(known_uncertainty(each.id, refined, std::nullopt)) << each.id;
    }
  }
}

TEST(Uncertainty, IsEstimatedAndSaysSoWhereNothingWasMeasured) {
  Dimension dimension;
  dimension.course_kind = CourseKind::tape;
  dimension.fit_error_m = 0.002;
  set_uncertainty(dimension, "girth_of_no_table", true, false);
  EXPECT_FALSE(dimension.uncertainty_is_measured);
  EXPECT_EQ(dimension.uncertainty_m, estimated_uncertainty(CourseKind::tape, true, 0.002));
  EXPECT_GT(*dimension.uncertainty_m, *estimated_uncertainty(CourseKind::tape, false, 0.002));
  set_uncertainty(dimension, "waist_girth", true, false);
  EXPECT_TRUE(dimension.uncertainty_is_measured);
  dimension.fit_error_m.reset();
  set_uncertainty(dimension, "waist_girth", true, false);
  EXPECT_FALSE(dimension.uncertainty_m);
  EXPECT_FALSE(dimension.uncertainty_is_measured);
}

TEST(FitError, AveragesTheObservedSegments) {
  FitErrors errors;
  errors[0] = 0.001;
  errors[3] = 0.003;
  EXPECT_DOUBLE_EQ(*mean_fit_error(1u << 0 | 1u << 3 | 1u << 5, errors), 0.002);
  EXPECT_FALSE(mean_fit_error(1u << 5, errors));
}

}  // namespace
}  // namespace vitruvian
