// Values of a JSON document that may hold anything: no access throws, what is missing or of another type is empty.
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::validate {

using Json = nlohmann::json;

/// The member of an object, or null.
inline const Json* member(const Json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}
inline const Json* member(const Json* object, std::string_view key) { return object ? member(*object, key) : nullptr; }

/// The element of an array, or null.
inline const Json* element(const Json* array, std::uint64_t i) {
  return array && array->is_array() && i < array->size() ? &(*array)[i] : nullptr;
}

inline std::optional<double> number(const Json* value) {
  if (!value || !value->is_number()) return std::nullopt;
  const double v = value->get<double>();
  return std::isfinite(v) ? std::optional(v) : std::nullopt;
}

/// A whole number from 0 to 2^53.
inline std::optional<std::uint64_t> whole(const Json* value) {
  if (!value || !value->is_number_integer()) return std::nullopt;
  if (value->is_number_unsigned()) {
    const auto v = value->get<std::uint64_t>();
    return v <= (1ull << 53) ? std::optional(v) : std::nullopt;
  }
  const auto v = value->get<std::int64_t>();
  return v >= 0 && v <= (1ll << 53) ? std::optional(static_cast<std::uint64_t>(v)) : std::nullopt;
}

/// The text of a string, else empty.
inline std::string text(const Json* value) {
  return value && value->is_string() ? value->get_ref<const std::string&>() : std::string();
}

inline bool is_true(const Json* value) { return value && value->is_boolean() && value->get<bool>(); }

/// An array of `count` finite numbers.
inline std::optional<std::vector<double>> numbers(const Json* value, std::size_t count) {
  if (!value || !value->is_array() || value->size() != count) return std::nullopt;
  std::vector<double> out;
  for (const Json& v : *value) {
    const auto n = number(&v);
    if (!n) return std::nullopt;
    out.push_back(*n);
  }
  return out;
}

/// The document, or nothing where `bytes` are no JSON.
inline std::optional<Json> parse_json(std::string_view bytes) {
  Json j = Json::parse(bytes, nullptr, /*allow_exceptions=*/false);
  if (j.is_discarded()) return std::nullopt;
  return j;
}

}  // namespace blockrand::validate
