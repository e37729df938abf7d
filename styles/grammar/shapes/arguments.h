// Reading the arguments of an operation.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "styles/grammar/shapes/operations.h"

namespace blockrand::grammar {

using Result = tl::expected<void, std::string>;
using Arguments = std::span<const Argument>;

inline tl::unexpected<std::string> failure(std::string text) { return tl::unexpected<std::string>(std::move(text)); }

/// NaN and infinity count as 0 (docs/rule_language.md §4.7).
inline double finite(double value) { return std::isfinite(value) ? value : 0; }

inline bool is_word(Arguments arguments, std::size_t i) { return i < arguments.size() && !arguments[i].word.empty(); }
inline std::string_view word(Arguments arguments, std::size_t i) {
  return i < arguments.size() ? std::string_view(arguments[i].word) : std::string_view{};
}
/// A number, or a truth value as 0 and 1; `otherwise` when there is no such argument or it is something else.
inline double number(Arguments arguments, std::size_t i, double otherwise = 0) {
  if (i >= arguments.size() || is_word(arguments, i)) return otherwise;
  if (const double* value = std::get_if<double>(&arguments[i].value)) return finite(*value);
  if (const bool* truth = std::get_if<bool>(&arguments[i].value)) return *truth ? 1 : 0;
  return otherwise;
}
/// As number(), times `whole` when the argument is relative.
inline double measured(Arguments arguments, std::size_t i, double whole, double otherwise = 0) {
  const double value = number(arguments, i, otherwise);
  return i < arguments.size() && arguments[i].mark == Mark::relative ? finite(value * whole) : value;
}
inline bool is_number(Arguments arguments, std::size_t i) {
  return i < arguments.size() && !is_word(arguments, i) &&
         (std::holds_alternative<double>(arguments[i].value) || std::holds_alternative<bool>(arguments[i].value));
}
inline const std::string* text(Arguments arguments, std::size_t i) {
  return i < arguments.size() && !is_word(arguments, i) ? std::get_if<std::string>(&arguments[i].value) : nullptr;
}
inline Result wants_numbers(Arguments arguments, std::size_t from = 0) {
  for (std::size_t i = from; i < arguments.size(); ++i)
    if (!is_number(arguments, i)) return failure("argument " + std::to_string(i + 1) + " must be a number");
  return {};
}
inline std::string unknown_word(std::string_view given, std::string_view known) {
  return "\"" + std::string(given) + "\" is not one of: " + std::string(known);
}

}  // namespace blockrand::grammar
