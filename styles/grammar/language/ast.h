// A rule file as the parser read it: plain nodes in vectors, referred to by index. It never changes once parsed; what
// names mean is kept outside (program.h), since one file may be imported several times.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "styles/grammar/language/source.h"

namespace blockrand::grammar {

/// Index of a node in its vector of Unit.
using NodeId = std::uint32_t;
/// Index into Unit::names.
using NameId = std::uint32_t;
/// Number of a use of a name, from 0 in each file: index into Module::targets (program.h).
using UseId = std::uint32_t;
inline constexpr std::uint32_t kNone = 0xffffffffU;

/// How deep brackets, blocks and branches may stand in one another, so that nobody who walks the tree needs much stack.
inline constexpr int kMaximumNesting = 256;
/// Levels of an expression's tree: a sum of n terms has n.
inline constexpr int kMaximumHeight = 1000;

/// `count` entries from `first` on, in the vector that the member's comment names.
struct Range {
  std::uint32_t first = 0, count = 0;
  bool empty() const { return count == 0; }
};

/// A prefix of a whole argument or size (docs/rule_language.md §1.3, 4).
enum class Mark : std::uint8_t { plain, relative /* ' */, floating /* ~ */ };

enum class ExpressionKind : std::uint8_t {
  number,         ///< Expression::number
  text,           ///< Expression::text
  truth,          ///< Expression::number is 0 or 1
  name,           ///< a name or call: Expression::use, ::name, ::arguments, ::parentheses
  unary,          ///< ::op negate, plus or logical_not of ::first
  binary,         ///< ::op of ::first and ::second; && and || do not evaluate what they need not
  index,          ///< ::first indexed by ::list (one or two, each may be a range)
  array,          ///< ::rows
  range,          ///< ::first : ::third, or ::first : ::second : ::third with an increment (::second is kNone without)
  cases,          ///< ::branches: the first true condition's value; the last has no condition
  chances,        ///< ::branches: percentages; the last has none
  component_map,  ///< `comp(kind){ selector : value | … }`: ::arguments, ::component_values
};

enum class Operator : std::uint8_t {
  none,
  negate,
  plus,
  logical_not,
  add,
  subtract,
  multiply,
  divide,
  modulo,
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  logical_and,
  logical_or,
  // The element-wise forms with a leading dot.
  each_add,
  each_subtract,
  each_multiply,
  each_divide,
  each_modulo,
  each_equal,
  each_not_equal,
  each_less,
  each_less_equal,
  each_greater,
  each_greater_equal,
  each_and,
  each_or,
};
constexpr bool is_arithmetic(Operator op) { return op >= Operator::add && op <= Operator::modulo; }
constexpr bool is_comparison(Operator op) { return op >= Operator::equal && op <= Operator::greater_equal; }
constexpr bool is_connective(Operator op) { return op == Operator::logical_and || op == Operator::logical_or; }

struct Expression {
  Location location;
  ExpressionKind kind = ExpressionKind::number;
  Operator op = Operator::none;
  bool parentheses = false;  ///< name: written with parentheses, be they empty
  double number = 0;
  std::uint32_t text = kNone;  ///< into Unit::texts
  NameId name = kNone;
  UseId use = kNone;
  NodeId first = kNone, second = kNone, third = kNone;  ///< expressions
  Range arguments;                                      ///< into Unit::arguments
  Range list;                                           ///< into Unit::expression_lists
  Range rows;                                           ///< into Unit::rows
  Range branches;                                       ///< into Unit::branches; Branch::result is an expression
  Range component_values;                               ///< into Unit::component_values
};

/// An argument of a call; whether a bare name is a word (x, world.up, byHeight) or a value tells the target of its use.
struct ArgumentNode {
  NodeId value = kNone;  ///< an expression
  Mark mark = Mark::plain;
};

/// One way of `case … else` or `N% … else`.
struct Branch {
  Location location;
  NodeId condition = kNone;  ///< an expression; kNone is `else`
  NodeId result = kNone;     ///< a successor or an expression, as the owner says
};

/// How a selector's components become shapes (docs/rule_language.md §2.4).
enum class ItemOperator : std::uint8_t { each /* : */, all /* = */, connected /* =: */ };

/// An item of the comp function's block.
struct ComponentValue {
  Location location;
  NodeId selector = kNone;  ///< an expression
  ItemOperator op = ItemOperator::each;
  NodeId value = kNone;  ///< an expression
};

enum class SuccessorKind : std::uint8_t {
  steps,    ///< Successor::steps, left to right; may be empty
  cases,    ///< Successor::branches
  chances,  ///< Successor::branches
};

struct Successor {
  Location location;
  SuccessorKind kind = SuccessorKind::steps;
  Range steps;     ///< into Unit::steps
  Range branches;  ///< into Unit::branches; Branch::result is a successor
};

enum class StepKind : std::uint8_t {
  call,          ///< an operation or a symbol: Step::call
  push,          ///< `[ … ]`: Step::successor
  inlined_call,  ///< `inline X`: Step::call
  inlined,       ///< `inline { … }`: Step::successor
};

struct Step {
  Location location;
  StepKind kind = StepKind::call;
  NodeId call = kNone;         ///< into Unit::calls
  NodeId successor = kNone;    ///< into Unit::successors
  NameId inline_mode = kNone;  ///< append, unify or recompose; kNone when not given
};

struct Call {
  Location location;
  NameId name = kNone;  ///< without the trailing dot; of a dynamic import only what follows the prefix
  UseId use = kNone;
  bool terminal = false;          ///< `Name.`: the terminal symbol, never a rule
  bool parentheses = false;       ///< written with parentheses
  Range arguments;                ///< into Unit::arguments
  NodeId block = kNone;           ///< into Unit::blocks
  NodeId dynamic_import = kNone;  ///< into Unit::dynamic_imports: `imp( h = 3 ).Rule`
};

enum class BlockKind : std::uint8_t {
  none,
  split,      ///< `size : successor` and `{ … }*`: split, splitArea
  selectors,  ///< `selector op successor`: comp, setback…, shapeL/U/O, innerRectangle, modify, offset-like
  perimeter,  ///< `length : depth : successor`, then a second block: splitAndSetbackPerimeter
  scatter,    ///< one successor
  boolean,    ///< two successors: union, subtract, intersect
};

enum class ItemKind : std::uint8_t {
  sized,     ///< BlockItem::mark, ::value (the size), ::depth (perimeter only), ::successor
  group,     ///< `{ … }` or `{ … }*` inside a split: BlockItem::items, ::repeat
  selector,  ///< BlockItem::value (the selector), ::op, ::successor
  plain,     ///< BlockItem::successor
};

struct BlockItem {
  Location location;
  ItemKind kind = ItemKind::plain;
  Mark mark = Mark::plain;
  ItemOperator op = ItemOperator::each;
  bool repeat = false;
  NodeId value = kNone, depth = kNone;  ///< expressions
  NodeId successor = kNone;
  Range items;  ///< into Unit::items
};

struct Block {
  Location location;
  BlockKind kind = BlockKind::none;
  bool repeat = false;  ///< `}*`
  Range items;          ///< into Unit::items
  Range remainder;      ///< into Unit::items: the second block of a perimeter split
};

/// `Name`, `@Name`, `@Name(…)`; what is in the parentheses is kept as it was written.
struct Annotation {
  Location location;
  std::string name;
  std::string arguments;
};

enum class DeclarationKind : std::uint8_t { attribute, constant, function, rule };

/// A parameter, or a binding of `with`.
struct Parameter {
  Location location;
  NameId name = kNone;
  NodeId value = kNone;  ///< bindings: an expression, evaluated once at each call, in order
};

struct Declaration {
  Location location;
  DeclarationKind kind = DeclarationKind::rule;
  NameId name = kNone;    ///< without the prefix
  NameId prefix = kNone;  ///< `imp.R -->`: the import whose rule is redefined
  bool start = false, extension = false;
  bool override_rule = false;        ///< stands in the parentheses of an import
  std::uint32_t style = 0;           ///< into Unit::styles; 0 is Default
  Range parameters;                  ///< into Unit::parameters
  Range bindings;                    ///< into Unit::parameters; they follow the parameters in the frame of local values
  NodeId value = kNone;              ///< attribute, constant, function: an expression
  NodeId successor = kNone;          ///< rule
  Range annotations;                 ///< into Unit::annotations
  bool broken = false;               ///< could not be read (that was told): it has no value and no successor
  Range own_expressions, own_calls;  ///< into Unit::expressions and ::calls: what was read between its begin and end
  std::uint32_t frame_size() const { return parameters.count + bindings.count; }
};

struct Style {
  Location location;
  NameId name = kNone;  ///< kNone: Default
  NameId base = kNone;  ///< `extends`; kNone: Default
  Range annotations;
};

enum class OverrideKind : std::uint8_t { protect, attribute, rule };

/// What stands in the parentheses of an import (docs/rule_language.md §1.5).
struct Override {
  Location location;
  OverrideKind kind = OverrideKind::protect;
  NameId name = kNone;
  NodeId value = kNone;        ///< attribute: an expression of the importing file
  Range own_expressions;       ///< into Unit::expressions: what was read for the value
  NodeId declaration = kNone;  ///< rule: into Unit::declarations
};

struct Import {
  Location location;
  NameId name = kNone;
  std::uint32_t path = kNone;  ///< into Unit::texts
  Location path_location;
  Range styles;              ///< into Unit::style_names
  bool parentheses = false;  ///< `( … )` after the file: with nothing inside all attributes are protected
  Range overrides;           ///< into Unit::overrides
  std::uint32_t style = 0;   ///< where the import stands: into Unit::styles
  Range annotations;
};

/// `imp( … ).Rule`: the imported file's attributes begin anew for this call.
struct DynamicImport {
  Location location;
  NameId name = kNone;
  Range overrides;  ///< into Unit::overrides
};

/// One rule file.
struct Unit {
  std::uint32_t file = 0;  ///< index into Program::files
  std::string version = "2009.1";
  Location version_location;

  std::vector<std::string> names;  ///< distinct
  std::vector<std::string> texts;  ///< strings, escapes resolved
  std::vector<Expression> expressions;
  std::vector<NodeId> expression_lists;
  std::vector<Range> rows;  ///< into expression_lists
  std::vector<ArgumentNode> arguments;
  std::vector<Branch> branches;
  std::vector<ComponentValue> component_values;
  std::vector<Successor> successors;
  std::vector<Step> steps;
  std::vector<Call> calls;
  std::vector<Block> blocks;
  std::vector<BlockItem> items;
  std::vector<Annotation> annotations;
  std::vector<Parameter> parameters;
  std::vector<Declaration> declarations;  ///< in the order of the file
  std::vector<Style> styles{Style{}};     ///< entry 0 is Default
  std::vector<NameId> style_names;
  std::vector<Override> overrides;
  std::vector<Import> imports;
  std::vector<DynamicImport> dynamic_imports;
  std::uint32_t use_count = 0;

  const std::string& name(NameId id) const { return names[id]; }
  template <typename T>
  static std::span<const T> slice(const std::vector<T>& all, Range range) {
    return std::span<const T>(all).subspan(range.first, range.count);
  }
};

}  // namespace blockrand::grammar
