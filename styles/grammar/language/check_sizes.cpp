// Numbers that are known before anything runs: probabilities, conditions, sizes.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "styles/grammar/language/check_parts.h"

namespace blockrand::grammar::detail {

namespace {

/// Sums of percentages as people write them: 3 × 33.3333.
constexpr double kPercentTolerance = 1e-3;
/// Of the whole: the splits' own tolerance (docs/rule_language.md §7.2, 8).
constexpr double kLengthTolerance = 1e-6;

/// Bounds of folding: constants that refer to one another could make it endless.
struct Budget {
  int constants = 8;
  int steps = 2000;
};

std::optional<double> folded(Operator op, double a, double b) {
  if (op == Operator::add) return a + b;
  if (op == Operator::subtract) return a - b;
  if (op == Operator::multiply) return a * b;
  if (op == Operator::divide) return a / b;
  if (op == Operator::modulo) return std::fmod(a, b);
  if (op == Operator::equal) return a == b;
  if (op == Operator::not_equal) return a != b;
  if (op == Operator::less) return a < b;
  if (op == Operator::less_equal) return a <= b;
  if (op == Operator::greater) return a > b;
  if (op == Operator::greater_equal) return a >= b;
  if (op == Operator::logical_and) return a != 0 && b != 0;
  if (op == Operator::logical_or) return a != 0 || b != 0;
  return std::nullopt;
}

std::optional<double> folded(const Checked& c, NodeId id, Budget& constants) {
  if (--constants.steps < 0) return std::nullopt;
  const Expression& e = c.expression(id);
  switch (e.kind) {
    case ExpressionKind::number:
    case ExpressionKind::truth:
      return e.number;
    case ExpressionKind::unary: {
      const auto value = folded(c, e.first, constants);
      if (!value) return std::nullopt;
      return e.op == Operator::negate ? -*value : e.op == Operator::logical_not ? (*value == 0 ? 1.0 : 0.0) : *value;
    }
    case ExpressionKind::binary: {
      const auto a = folded(c, e.first, constants);
      if (!a) return std::nullopt;
      const auto b = folded(c, e.second, constants);
      if (!b) return std::nullopt;
      return folded(e.op, *a, *b);
    }
    case ExpressionKind::name: {
      // Constants of the same file only: those of imports are folded where they are checked.
      const Target& target = c.module.targets[e.use];
      if (target.kind != TargetKind::attribute || constants.constants == 0) return std::nullopt;
      const Slot& slot = c.program.slots[target.index];
      if (!slot.constant || c.program.modules[slot.module].unit.get() != &c.unit ||
          &c.program.modules[slot.module] != &c.module)
        return std::nullopt;
      --constants.constants;
      const auto value = folded(c, slot.value, constants);
      ++constants.constants;
      return value;
    }
    case ExpressionKind::text:
    case ExpressionKind::index:
    case ExpressionKind::array:
    case ExpressionKind::range:
    case ExpressionKind::cases:
    case ExpressionKind::chances:
    case ExpressionKind::component_map:
      break;
  }
  return std::nullopt;
}

void check_branches(const Checked& c, Range range, bool chances) {
  const auto branches = Unit::slice(c.unit.branches, range);
  if (branches.empty()) return;
  if (!chances) {
    for (std::size_t i = 0; i < branches.size(); ++i) {
      if (branches[i].condition == kNone) continue;
      const auto truth = constant_truth(c, branches[i].condition);
      if (!truth) continue;
      if (!*truth)
        c.tell(Severity::warning, "never", branches[i].location, "this condition is never true");
      else if (i + 1 < branches.size())
        c.tell(Severity::warning, "never", branches[i + 1].location,
               "the condition before is always true: this can never happen");
    }
    return;
  }
  double sum = 0;
  bool all_known = true;
  for (const Branch& branch : branches) {
    if (branch.condition == kNone) break;
    const auto percent = constant_number(c, branch.condition);
    if (!percent) {
      all_known = false;
      continue;
    }
    if (*percent < 0)
      c.tell(Severity::error, "probability", c.expression(branch.condition).location, "a probability below 0 %");
    sum += *percent;
    if (sum > 100 + kPercentTolerance) {
      c.tell(Severity::error, "probability", c.expression(branch.condition).location,
             fmt::format("the probabilities up to here sum to {:g} %, more than 100 %", sum));
      return;
    }
  }
  if (all_known && sum >= 100 - kPercentTolerance && branches.back().condition == kNone)
    c.tell(Severity::note, "never", branches.back().location,
           "the probabilities sum to 100 %: this 'else' never happens");
}

using Sizes = std::array<std::optional<double>, 3>;

/// Walks successors with what is known of the scope's size.
class SizeWalk {
 public:
  explicit SizeWalk(const Checked& c) : c_(c) {}

  void successor(NodeId id, Sizes sizes) {
    const Successor& node = c_.unit.successors[id];
    for (const Branch& branch : Unit::slice(c_.unit.branches, node.branches)) successor(branch.result, sizes);
    for (const Step& step : Unit::slice(c_.unit.steps, node.steps)) {
      if (step.successor != kNone) successor(step.successor, sizes);
      if (step.call != kNone) call(c_.unit.calls[step.call], sizes);
    }
  }

 private:
  void call(const Call& call, Sizes& sizes) {
    const Target& target = c_.module.targets[call.use];
    const auto arguments = Unit::slice(c_.unit.arguments, call.arguments);
    if (target.kind == TargetKind::operation) {
      const std::string_view name = built_ins()[target.index].name;
      if (name == "s") {
        for (std::size_t a = 0; a < 3; ++a) {
          const auto value = constant_number(c_, arguments[a].value);
          if (arguments[a].mark == Mark::plain)
            sizes[a] = value;
          else if (value && sizes[a])
            sizes[a] = *value * *sizes[a];
          else
            sizes[a] = std::nullopt;
        }
        return;
      }
      if (name == "extrude") {
        sizes = {};
        if (arguments.size() == 1) sizes[1] = constant_number(c_, arguments[0].value);
        return;
      }
      if (call.block != kNone) return block(call, name, sizes);
      if (!keeps_size(name)) sizes = {};
    }
  }

  /// What is in no list may change the scope.
  static bool keeps_size(std::string_view name) {
    for (const std::string_view keeper :
         {"t",        "r",           "center",   "translate",       "rotate",    "color",  "set",        "texture",
          "report",   "print",       "label",    "setupProjection", "projectUV", "tileUV", "scaleUV",    "translateUV",
          "rotateUV", "normalizeUV", "deleteUV", "reverseNormals",  "mirror",    "tag",    "deleteTags", "NIL"})
      if (keeper == name) return true;
    return false;
  }

  void block(const Call& call, std::string_view name, const Sizes& sizes) {
    const Block& node = c_.unit.blocks[call.block];
    int axis = -1;
    if (name == "split") {
      const Expression& e = c_.expression(c_.unit.arguments[call.arguments.first].value);
      if (e.kind == ExpressionKind::name && c_.module.targets[e.use].kind == TargetKind::word) {
        const std::string_view word = c_.unit.name(e.name);
        axis = word == "x" ? 0 : word == "y" ? 1 : word == "z" ? 2 : -1;
      }
    }
    const std::optional<double> whole = axis < 0 ? std::nullopt : sizes[static_cast<std::size_t>(axis)];
    if (node.kind == BlockKind::split && !node.repeat && name == "split") fit(node.items, whole);
    items(node.items, node.kind == BlockKind::split ? sizes : Sizes{}, axis, whole);
    items(node.remainder, {}, -1, {});
  }

  void items(Range range, const Sizes& sizes, int axis, std::optional<double> whole) {
    for (const BlockItem& item : Unit::slice(c_.unit.items, range)) {
      if (item.kind == ItemKind::group) {
        items(item.items, sizes, axis, whole);
        continue;
      }
      Sizes inner = sizes;
      if (item.kind == ItemKind::sized) {
        const auto value = constant_number(c_, item.value);
        if (value && *value <= 0)
          c_.tell(Severity::warning, "size", c_.expression(item.value).location, "a piece of this size never appears");
        if (axis >= 0) {
          std::optional<double>& size = inner[static_cast<std::size_t>(axis)];
          size = std::nullopt;
          if (value && item.mark == Mark::plain) size = whole ? std::min(*value, *whole) : *value;
          if (value && item.mark == Mark::relative && whole) size = *value * *whole;
        }
      }
      successor(item.successor, inner);
    }
  }

  /// Sizes that are fixed, against the whole; nested groups stand at least once.
  void fit(Range range, std::optional<double> whole) {
    if (range.empty()) return;
    double absolute = 0, relative = 0;
    bool floating = false;
    sum(range, absolute, relative, floating);
    const Location place = c_.unit.items[range.first].location;
    if (relative > 1 + kLengthTolerance) {
      c_.tell(Severity::warning, "size", place,
              fmt::format("the relative sizes sum to {:g}: more than the whole", relative));
    } else if (whole && *whole > 0) {
      const double fixed = absolute + relative * *whole;
      if (fixed > *whole * (1 + kLengthTolerance))
        c_.tell(Severity::warning, "size", place,
                fmt::format(
                    "the fixed sizes need {:g}, but the shape measures {:g} here: the last pieces are cut or missing",
                    fixed, *whole));
      else if (floating && fixed > *whole * (1 - kLengthTolerance))
        c_.tell(Severity::warning, "size", place,
                fmt::format("the fixed sizes fill all {:g}: nothing is left for the floating ones", *whole));
    }
  }

  void sum(Range range, double& absolute, double& relative, bool& floating) const {
    for (const BlockItem& item : Unit::slice(c_.unit.items, range)) {
      if (item.kind == ItemKind::group) {
        sum(item.items, absolute, relative, floating);
        continue;
      }
      if (item.mark == Mark::floating) floating = true;
      const auto value = constant_number(c_, item.value);
      if (!value || *value <= 0 || item.mark == Mark::floating) continue;
      (item.mark == Mark::relative ? relative : absolute) += *value;
    }
  }

  const Checked& c_;
};

}  // namespace

std::optional<double> constant_number(const Checked& c, NodeId expression) {
  // Nothing that is known to be a text or a truth value is taken for a number.
  if (const auto type = c.module.types[expression]; type && *type != Type::number) return std::nullopt;
  Budget budget;
  return folded(c, expression, budget);
}

std::optional<bool> constant_truth(const Checked& c, NodeId expression) {
  if (c.module.types[expression] != Type::truth) return std::nullopt;
  Budget budget;
  const auto value = folded(c, expression, budget);
  return value ? std::optional(*value != 0) : std::nullopt;
}

void check_choices(const Checked& c) {
  for (const Expression& e : c.unit.expressions)
    if (e.kind == ExpressionKind::cases || e.kind == ExpressionKind::chances)
      check_branches(c, e.branches, e.kind == ExpressionKind::chances);
  for (const Successor& s : c.unit.successors)
    if (s.kind != SuccessorKind::steps) check_branches(c, s.branches, s.kind == SuccessorKind::chances);
}

void check_sizes(const Checked& c) {
  SizeWalk walk(c);
  for (const Declaration& d : c.unit.declarations)
    if (d.successor != kNone) walk.successor(d.successor, {});
}

}  // namespace blockrand::grammar::detail
