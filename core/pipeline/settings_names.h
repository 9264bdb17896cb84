#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "pipeline/settings.h"

namespace vitruvian {

/// A value of an enumeration and its name in options and files.
template <typename Enum>
struct NamedValue {
  Enum value;
  std::string_view name;
};

/// All values of Method, AlignMode, InitMode, SolverKind, DetailMode, Unit, Axis or Gender with the names
/// that to_string() gives, in the order of the contract.
template <typename Enum>
std::span<const NamedValue<Enum>> named_values();

/// The value of that name; none when there is no such name.
template <typename Enum>
std::optional<Enum> value_named(std::string_view name) {
  for (const NamedValue<Enum>& candidate : named_values<Enum>()) {
    if (candidate.name == name) return candidate.value;
  }
  return std::nullopt;
}

}  // namespace vitruvian
