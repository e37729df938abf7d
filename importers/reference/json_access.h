// JSON of unknown make: members that may be missing or of another type. Nothing here recurses, or throws but for
// nesting without end. Internal to this folder.
#pragma once

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "importers/reference/coordinate_text.h"

namespace blockrand::importers::reference {

using Json = nlohmann::json;

/// Levels of a JSON text. Models have about ten, and attributes a few more; beyond, a small archive may hold gigabytes
/// of nothing but brackets.
inline constexpr std::size_t kDeepestJson = 512;

/// What to say of a text with more levels.
inline std::string too_deep_text() { return "is JSON nested deeper than " + std::to_string(kDeepestJson) + " levels"; }

/// null where there is no such member, or `object` is none.
inline const Json& member(const Json& object, const char* key) {
  static const Json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

/// null where there is no such element, or `array` is none.
inline const Json& element(const Json& array, std::size_t i) {
  static const Json kNothing;
  return array.is_array() && i < array.size() ? array[i] : kNothing;
}

/// Elements of an array; 0 of anything else.
inline std::size_t length(const Json& array) { return array.is_array() ? array.size() : 0; }

/// The number; nothing where it is none or not finite.
inline std::optional<double> number(const Json& value) {
  if (!value.is_number()) return std::nullopt;
  const double out = value.get<double>();
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

/// A whole number from 0 on, also written as 3.0.
inline std::optional<std::size_t> index(const Json& value) {
  constexpr double kLargest = 9e15;  // whole in a double
  const auto v = number(value);
  if (!v || *v < 0 || *v > kLargest || *v != std::floor(*v)) return std::nullopt;
  return static_cast<std::size_t>(*v);
}

/// The element that another member names by its number; null where it names none.
inline const Json& element_of(const Json& array, const Json& number) {
  const auto i = index(number);
  return element(array, i ? *i : length(array));
}

/// The text; empty where it is none.
inline std::string text(const Json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }

/// A number, also one that is written as a text.
inline std::optional<double> loose_number(const Json& value) {
  if (value.is_string()) return number_of(value.get_ref<const std::string&>());
  return number(value);
}

/// A scalar as a text; nothing for objects, arrays and null.
inline std::optional<std::string> scalar_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean() || value.is_number()) return value.dump();
  return std::nullopt;
}

}  // namespace blockrand::importers::reference
