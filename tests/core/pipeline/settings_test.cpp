#include "pipeline/settings.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "pipeline/settings_names.h"

namespace vitruvian {
namespace {

template <typename Enum>
void expect_round_trip(std::size_t count) {
  EXPECT_EQ(named_values<Enum>().size(), count);
  for (const NamedValue<Enum>& entry : named_values<Enum>()) {
    EXPECT_EQ(value_named<Enum>(entry.name), entry.value);
    if constexpr (std::is_same_v<Enum, Gender>) {
      EXPECT_EQ(name_of(entry.value), entry.name);
    } else {
      EXPECT_EQ(to_string(entry.value), entry.name);
    }
  }
  EXPECT_FALSE(value_named<Enum>("Auto"));
  EXPECT_FALSE(value_named<Enum>(""));
}

TEST(Settings, NamesRoundTrip) {
  expect_round_trip<Method>(3);
  expect_round_trip<AlignMode>(2);
  expect_round_trip<InitMode>(4);
  expect_round_trip<SolverKind>(2);
  expect_round_trip<DetailMode>(2);
  expect_round_trip<Unit>(5);
  expect_round_trip<Axis>(7);
  expect_round_trip<Gender>(3);
}

TEST(Settings, NamesAreTheContracts) {
  EXPECT_EQ(to_string(Method::paper_cpu), "paper-cpu");
  EXPECT_EQ(to_string(Axis::minus_y), "-y");
  EXPECT_EQ(to_string(Unit::inch), "in");
}

TEST(Settings, UnitsHaveLengths) {
  EXPECT_EQ(metres_per_unit(Unit::metre), 1);
  EXPECT_EQ(metres_per_unit(Unit::centimetre), 0.01);
  EXPECT_EQ(metres_per_unit(Unit::millimetre), 0.001);
  EXPECT_EQ(metres_per_unit(Unit::inch), 0.0254);
  EXPECT_THROW(metres_per_unit(Unit::automatic), Error);
}

}  // namespace
}  // namespace vitruvian
