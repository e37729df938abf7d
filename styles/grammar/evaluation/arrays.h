// Arrays: literals, ranges, indexing, and operators of single values and element by element
// (docs/rule_language.md §1.2, §3.2).
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "styles/grammar/language/ast.h"
#include "styles/grammar/language/value.h"

namespace blockrand::grammar {

using ValueResult = tl::expected<Value, std::string>;

/// 0, false or "": what a missing element counts as.
Value default_value(Type type);
/// The type of a value's elements; single values are their own.
Type item_type(Type type);
/// The type of an array of such elements.
Type array_type(Type type);

/// base, base + step ... up to limit. Empty where the step leads away or is 0.
ValueResult make_range(double base, double step, double limit);

/// `[a, b; c, d]`: rows of single values and arrays of one element type. Arrays in a row stand side by side; what
/// shorter ones lack is filled with defaults.
ValueResult make_array(std::span<const std::vector<Value>> rows);

/// `array[index]`; the index is a number, an array of numbers, or truth values (page func_index). What is outside is
/// the default.
ValueResult index_value(const Value& array, const Value& index);
/// `array[row, column]`.
ValueResult index_value(const Value& array, const Value& row, const Value& column);

/// Of a comparison.
template <typename T>
bool compare(Operator op, const T& a, const T& b) {
  if (op == Operator::equal) return a == b;
  if (op == Operator::not_equal) return !(a == b);
  if (op == Operator::less) return a < b;
  if (op == Operator::less_equal) return a <= b;
  if (op == Operator::greater) return a > b;
  return op == Operator::greater_equal && a >= b;
}

/// Of an arithmetic operator.
inline double calculate(Operator op, double a, double b) {
  if (op == Operator::add) return a + b;
  if (op == Operator::subtract) return a - b;
  if (op == Operator::multiply) return a * b;
  if (op == Operator::divide) return a / b;
  return std::fmod(a, b);
}

ValueResult apply_unary(Operator op, const Value& value);
/// All but && and ||, which do not evaluate what they need not, and are the evaluator's; their values may come here.
ValueResult apply_binary(Operator op, const Value& left, const Value& right);

}  // namespace blockrand::grammar
