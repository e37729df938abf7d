// What an expression of a rule file evaluates to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace blockrand::grammar {

/// A two-dimensional array, row by row (docs/rule_language.md §1.2, §3.2); one-dimensional ones have one row.
/// Truth values are stored as bytes, so that elements have addresses.
template <typename T>
struct Array {
  std::vector<T> items;
  std::size_t columns = 0;  ///< 0 when empty

  std::size_t rows() const { return columns == 0 ? 0 : items.size() / columns; }
  bool operator==(const Array&) const = default;
};
using NumberArray = Array<double>;
using TruthArray = Array<std::uint8_t>;
using TextArray = Array<std::string>;

/// The types of the language, in the order of the variant's alternatives.
enum class Type : std::uint8_t { number, truth, text, number_array, truth_array, text_array };

/// Numbers are doubles, compared as IEEE does. Lengths in metres, angles in degrees, as rule files write them.
using Value = std::variant<double, bool, std::string, NumberArray, TruthArray, TextArray>;

inline Type type_of(const Value& value) { return static_cast<Type>(value.index()); }

}  // namespace blockrand::grammar
