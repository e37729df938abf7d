// Numbers of element files that depend on size and parameters: "(w - 2 * frame) / n". Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace blockrand::elements {

/// Characters of an expression, and brackets and signs within one another: bad input ends here.
inline constexpr std::size_t kLongestExpression = 1000;
inline constexpr int kDeepestNesting = 32;

/// A calculation that is read once and made often. Numbers, names, + - * /, brackets, min(…) and max(…) of two values or
/// more.
class Expression {
 public:
  Expression() = default;  ///< 0
  explicit Expression(double number) : steps_{{Step::Kind::number, 0, number}} {}

  /// \param names  what may be asked for; value() gets their values in the same order
  /// Error: place and remedy, "column 7: there is no \"hight\"; did you mean \"height\"?".
  static tl::expected<Expression, std::string> parse(std::string_view text, std::span<const std::string> names);

  /// Not finite where something is divided by 0, or too large. \param values  one for each name
  double value(std::span<const double> values) const;

 private:
  friend class ExpressionParser;
  /// As on a pocket calculator with a stack: operands first.
  struct Step {
    enum class Kind : std::uint8_t { number, name, add, subtract, multiply, divide, negate, least, most } kind;
    std::uint32_t name;
    double number;
  };
  std::vector<Step> steps_;
};

/// Is it one that a parameter may have: a letter first, then letters, digits and `_`, none of our own words.
bool is_free_name(std::string_view name);

}  // namespace blockrand::elements
