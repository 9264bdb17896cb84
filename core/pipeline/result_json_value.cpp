#include "pipeline/result_json_value.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

std::string scalar_text(const ordered_json& value, int indent = -1) {
  return value.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

bool is_row(const ordered_json& value) {
  return value.is_array() &&
         std::all_of(value.begin(), value.end(), [](const ordered_json& e) { return e.is_primitive(); });
}

/// A row of plain values, or an object of nothing but plain values and rows: fits on a line.
bool is_line(const ordered_json& value) {
  if (value.is_primitive() || is_row(value)) return true;
  return value.is_object() && std::all_of(value.begin(), value.end(), [](const ordered_json& e) {
           return e.is_primitive() || is_row(e);
         });
}

void append_line(const ordered_json& value, std::string& out) {
  if (value.is_primitive()) {
    out += scalar_text(value);
    return;
  }
  out += value.is_array() ? "[" : "{";
  bool first = true;
  for (const auto& [key, element] : value.items()) {
    if (!first) out += ", ";
    first = false;
    if (value.is_object()) out += scalar_text(key) + ": ";
    append_line(element, out);
  }
  out += value.is_array() ? "]" : "}";
}

void append_pretty(const ordered_json& value, int depth, std::string& out) {
  // Objects directly below the root are opened up, deeper ones stay on their line where they can.
  const bool open = depth == 0 || !is_line(value) || (value.is_object() && depth == 1);
  if (!open || value.empty()) {
    append_line(value, out);
    return;
  }
  const std::string indent(static_cast<std::size_t>(2 * (depth + 1)), ' ');
  out += value.is_array() ? "[" : "{";
  bool first = true;
  for (const auto& [key, element] : value.items()) {
    out += first ? "\n" : ",\n";
    first = false;
    out += indent;
    if (value.is_object()) out += scalar_text(key) + ": ";
    append_pretty(element, depth + 1, out);
  }
  out += "\n" + std::string(static_cast<std::size_t>(2 * depth), ' ') + (value.is_array() ? "]" : "}");
}

}  // namespace

bool JsonValue::has(std::string_view key) const {
  return value_->is_object() && value_->contains(std::string(key));
}

JsonValue JsonValue::at(std::string_view key) const {
  if (!value_->is_object()) fail("an object is expected");
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) fail("\"" + std::string(key) + "\" is missing");
  return {*found, file_name_, joined(key)};
}

JsonValue JsonValue::at(std::size_t index) const {
  if (index >= size()) fail("has fewer than " + std::to_string(index + 1) + " elements");
  return {(*value_)[index], file_name_, place_ + "[" + std::to_string(index) + "]"};
}

std::size_t JsonValue::size() const {
  if (!value_->is_array()) fail("an array is expected");
  return value_->size();
}

double JsonValue::number() const {
  if (!value_->is_number()) fail("a number is expected");
  const auto number = value_->get<double>();
  if (!std::isfinite(number)) fail("the number is out of range");
  return number;
}

std::int64_t JsonValue::whole(std::int64_t low, std::int64_t high) const {
  const double value = number();
  if (value != std::floor(value) || value < static_cast<double>(low) || value > static_cast<double>(high)) {
    fail("a whole number from " + std::to_string(low) + " to " + std::to_string(high) + " is expected");
  }
  return static_cast<std::int64_t>(value);
}

std::string JsonValue::text() const {
  if (!value_->is_string()) fail("a text is expected");
  return value_->get<std::string>();
}

bool JsonValue::truth() const {
  if (!value_->is_boolean()) fail("true or false is expected");
  return value_->get<bool>();
}

Vec3d JsonValue::vector3() const {
  if (!value_->is_array() || value_->size() != 3) fail("three numbers [x, y, z] are expected");
  return {at(std::size_t{0}).number(), at(1).number(), at(2).number()};
}

Mat4d JsonValue::matrix4() const {
  if (!value_->is_array() || value_->size() != 4) fail("four rows of four numbers are expected");
  Mat4d matrix;
  for (std::size_t r = 0; r < 4; ++r) {
    const JsonValue row = at(r);
    if (row.size() != 4) row.fail("four numbers are expected");
    for (std::size_t c = 0; c < 4; ++c) matrix(static_cast<int>(r), static_cast<int>(c)) = row.at(c).number();
  }
  return matrix;
}

Eigen::VectorXd JsonValue::numbers() const {
  Eigen::VectorXd result(static_cast<Index>(size()));
  for (std::size_t i = 0; i < size(); ++i) result[static_cast<Index>(i)] = at(i).number();
  return result;
}

void JsonValue::fail(const std::string& what) const {
  throw Error(ErrorCode::bad_file, file_name_ + ": " + (place_.empty() ? "" : place_ + ": ") + what);
}

std::string JsonValue::joined(std::string_view key) const {
  return place_.empty() ? std::string(key) : place_ + "." + std::string(key);
}

nlohmann::json parse_json(std::string_view text, const std::string& file_name) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto at = std::min(text.size(), static_cast<std::size_t>(error.byte));
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw Error(ErrorCode::bad_file,
                file_name + ": line " + std::to_string(line) + ": this is no JSON: " + error.what());
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::bad_file, file_name + ": this is no JSON that can be read: " + error.what());
  }
}

std::string json_text(const ordered_json& document, JsonStyle style) {
  if (style == JsonStyle::compact) return scalar_text(document);
  std::string out;
  append_pretty(document, 0, out);
  return out + "\n";
}

}  // namespace vitruvian
