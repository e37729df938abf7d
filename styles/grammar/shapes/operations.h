// What the evaluator calls to change a shape: every operation of the language that works in place, in one table.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "styles/grammar/language/ast.h"
#include "styles/grammar/language/value.h"
#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

/// An evaluated argument of an operation.
struct Argument {
  using Mark = grammar::Mark;
  Mark mark = Mark::plain;
  Value value = 0.0;  ///< when not a word
  std::string word;   ///< bare keyword arguments as written: world, scope.xy, byHeight; empty: `value` counts
};

/// What an operation may look at besides the shape it changes.
struct OperationInput {
  const Shape& base;     ///< the previous shape on the stack: relative sizes and center() refer to it
                         ///< (docs/rule_language.md §2.0)
  const Shape& initial;  ///< the initial shape, for resetGeometry()
};

/// Runs an operation that changes the shape in place. An error's text says what is wrong with the call, without place
/// and without the operation's name; the shape is then unchanged. Numbers that are NaN or infinite count as 0
/// (docs/rule_language.md §4.7). Geometry that cannot take the operation (a roof on nothing, a face without area) is no
/// error: what cannot be done is left as it was.
using Operation = tl::expected<void, std::string> (*)(Shape&, const OperationInput&, std::span<const Argument>);

struct OperationEntry {
  std::string_view name;
  int least = 0, most = 0;  ///< number of arguments
  std::uint32_t words = 0;  ///< bit i: argument i may be a bare word
  Operation run = nullptr;
};

/// An operation that runs here. Null for what is not there yet; operations with blocks have functions of their own
/// (split.h, components.h, pieces.h), and NIL, print, report, label and symbols are the evaluator's. `set` is
/// set_attribute() for what this folder knows, and the evaluator's for generic attributes.
const OperationEntry* find_operation(std::string_view name);

/// `set(name, value)` for scope.{tx…sz}, trim.{vertical,horizontal}, seedian and material.*
/// (docs/rule_language.md §3.1). Errors: attributes that cannot be set (pivot.*, split.*, comp.*, initialShape.*,
/// scope.elevation), values of a wrong type, names that are none of those.
tl::expected<void, std::string> set_attribute(Shape& shape, std::string_view name, const Value& value);

/// Reads scope.*, pivot.*, split.*, comp.*, trim.*, seedian and material.* (with the defaults of
/// docs/rule_language.md §3.1). Nothing for other names (initialShape.* is the evaluator's).
std::optional<Value> read_attribute(const Shape& shape, std::string_view name);

}  // namespace blockrand::grammar
