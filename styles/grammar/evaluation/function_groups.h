// The parts of the table of functions. Internal to this folder.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "styles/grammar/evaluation/functions.h"

namespace blockrand::grammar {

std::span<const FunctionEntry> maths_functions();
std::span<const FunctionEntry> conversion_functions();
std::span<const FunctionEntry> text_functions();
std::span<const FunctionEntry> list_functions();
std::span<const FunctionEntry> array_functions();
std::span<const FunctionEntry> colour_functions();
std::span<const FunctionEntry> file_functions();

using Arguments = std::span<const Value>;
inline double number(const Value& value) { return std::get<double>(value); }
inline bool truth(const Value& value) { return std::get<bool>(value); }
inline const std::string& text(const Value& value) { return std::get<std::string>(value); }

/// A count or index that a rule file wrote as a number: truncated, and kept within what fits.
inline long long whole(double value) {
  if (std::isnan(value)) return 0;
  constexpr double kMost = 1e15;
  return static_cast<long long>(value < -kMost ? -kMost : value > kMost ? kMost : value);
}

}  // namespace blockrand::grammar
