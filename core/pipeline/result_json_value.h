#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "base/types.h"
#include "pipeline/result_json.h"
#include "pipeline/settings_names.h"

namespace vitruvian {

/// A value of a JSON document together with its place, so that every complaint names file, place and what was
/// expected. Refers to the document.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& value, std::string file_name, std::string place)
      : value_(&value), file_name_(std::move(file_name)), place_(std::move(place)) {}

  bool is_null() const { return value_->is_null(); }
  bool is_array() const { return value_->is_array(); }
  bool has(std::string_view key) const;
  /// Member of an object. @throws Error(bad_file) when this is no object or has none of that name.
  JsonValue at(std::string_view key) const;
  /// Element of an array.
  JsonValue at(std::size_t index) const;
  /// Number of elements. @throws Error(bad_file) when this is no array.
  std::size_t size() const;
  /// Calls `use(name, value)` for each member of an object.
  template <typename Use>
  void for_each_member(const Use& use) const {
    if (!value_->is_object()) fail("an object is expected");
    for (const auto& [name, member] : value_->items()) use(name, JsonValue(member, file_name_, joined(name)));
  }

  /// A finite number.
  double number() const;
  /// A whole number in [low, high].
  std::int64_t whole(std::int64_t low, std::int64_t high) const;
  std::string text() const;
  /// true or false.
  bool truth() const;
  /// Three numbers.
  Vec3d vector3() const;
  /// Four rows of four numbers.
  Mat4d matrix4() const;
  Eigen::VectorXd numbers() const;

  /// @throws Error(bad_file) "FILE: PLACE: what".
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string joined(std::string_view key) const;

  const nlohmann::json* value_;
  std::string file_name_;
  std::string place_;
};

/// The value of an enumeration that a text names. @throws Error(bad_file) listing the names.
template <typename Enum>
Enum named(const JsonValue& value) {
  const std::optional<Enum> found = value_named<Enum>(value.text());
  if (!found) {
    std::string names;
    for (const NamedValue<Enum>& candidate : named_values<Enum>()) names += " " + std::string(candidate.name);
    value.fail("one of" + names + " is expected");
  }
  return *found;
}

/// All numbers of a matrix in one array, column by column.
template <typename Derived>
nlohmann::ordered_json numbers(const Eigen::MatrixBase<Derived>& values) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (Index c = 0; c < values.cols(); ++c) {
    for (Index r = 0; r < values.rows(); ++r) result.push_back(values(r, c));
  }
  return result;
}

/// Four rows of four numbers.
inline nlohmann::ordered_json rows(const Mat4d& matrix) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (int r = 0; r < 4; ++r) result.push_back(numbers(matrix.row(r)));
  return result;
}

/// Parses a whole document. @throws Error(bad_file) with line and column.
nlohmann::json parse_json(std::string_view text, const std::string& file_name);

/// Text of a document in one of the styles; bytes that are no UTF-8 are replaced, numbers that are not finite
/// are null.
std::string json_text(const nlohmann::ordered_json& document, JsonStyle style);

}  // namespace vitruvian
