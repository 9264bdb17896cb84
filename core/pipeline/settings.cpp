#include "pipeline/settings.h"

#include <array>

#include "base/error.h"
#include "pipeline/settings_names.h"

namespace vitruvian {
namespace {

constexpr std::array<NamedValue<Method>, 3> kMethods = {
    {{Method::ours, "ours"}, {Method::paper, "paper"}, {Method::paper_cpu, "paper-cpu"}}};
constexpr std::array<NamedValue<AlignMode>, 2> kAlignModes = {
    {{AlignMode::automatic, "auto"}, {AlignMode::pca, "pca"}}};
constexpr std::array<NamedValue<InitMode>, 4> kInitModes = {{{InitMode::automatic, "auto"},
                                                             {InitMode::keypoints, "keypoints"},
                                                             {InitMode::tpose, "tpose"},
                                                             {InitMode::file, "file"}}};
constexpr std::array<NamedValue<SolverKind>, 2> kSolvers = {
    {{SolverKind::fast, "fast"}, {SolverKind::paper, "paper"}}};
constexpr std::array<NamedValue<DetailMode>, 2> kDetailModes = {
    {{DetailMode::off, "off"}, {DetailMode::vertex, "vertex"}}};
constexpr std::array<NamedValue<Unit>, 5> kUnits = {{{Unit::automatic, "auto"},
                                                     {Unit::metre, "m"},
                                                     {Unit::centimetre, "cm"},
                                                     {Unit::millimetre, "mm"},
                                                     {Unit::inch, "in"}}};
constexpr std::array<NamedValue<Axis>, 7> kAxes = {{{Axis::automatic, "auto"},
                                                    {Axis::x, "x"},
                                                    {Axis::y, "y"},
                                                    {Axis::z, "z"},
                                                    {Axis::minus_x, "-x"},
                                                    {Axis::minus_y, "-y"},
                                                    {Axis::minus_z, "-z"}}};
constexpr std::array<NamedValue<Gender>, 3> kGenders = {
    {{Gender::neutral, "neutral"}, {Gender::female, "female"}, {Gender::male, "male"}}};

template <typename Enum>
std::string name_in_table(Enum value) {
  for (const NamedValue<Enum>& candidate : named_values<Enum>()) {
    if (candidate.value == value) return std::string(candidate.name);
  }
  throw Error(ErrorCode::internal, "setting out of range");
}

}  // namespace

template <>
std::span<const NamedValue<Method>> named_values() {
  return kMethods;
}
template <>
std::span<const NamedValue<AlignMode>> named_values() {
  return kAlignModes;
}
template <>
std::span<const NamedValue<InitMode>> named_values() {
  return kInitModes;
}
template <>
std::span<const NamedValue<SolverKind>> named_values() {
  return kSolvers;
}
template <>
std::span<const NamedValue<DetailMode>> named_values() {
  return kDetailModes;
}
template <>
std::span<const NamedValue<Unit>> named_values() {
  return kUnits;
}
template <>
std::span<const NamedValue<Axis>> named_values() {
  return kAxes;
}
template <>
std::span<const NamedValue<Gender>> named_values() {
  return kGenders;
}

Settings settings_of(Method method) {
  Settings settings;
  settings.method = method;
  if (method == Method::ours) return settings;
  settings.align = AlignMode::pca;
  settings.views = 2;
  settings.min_visibility = kPaperMinVisibility;
  settings.init = InitMode::keypoints;
  settings.solver = SolverKind::paper;
  if (method == Method::paper_cpu) {
    settings.one_directional = true;
    settings.iterations = 2000;
    settings.adam_iterations = 100;
  }
  return settings;
}

std::string to_string(Method value) { return name_in_table(value); }
std::string to_string(AlignMode value) { return name_in_table(value); }
std::string to_string(InitMode value) { return name_in_table(value); }
std::string to_string(SolverKind value) { return name_in_table(value); }
std::string to_string(DetailMode value) { return name_in_table(value); }
std::string to_string(Unit value) { return name_in_table(value); }
std::string to_string(Axis value) { return name_in_table(value); }

double metres_per_unit(Unit unit) {
  switch (unit) {
    case Unit::metre:
      return 1;
    case Unit::centimetre:
      return 0.01;
    case Unit::millimetre:
      return 0.001;
    case Unit::inch:
      return 0.0254;
    case Unit::automatic:
      break;
  }
  throw Error(ErrorCode::internal, "an automatic unit has no length");
}

}  // namespace vitruvian
