// Values of the wrong type, where types are known without running (docs/rule_language.md §1.3, 9).
#include <array>

#include "styles/grammar/language/check_parts.h"

namespace blockrand::grammar::detail {

namespace {

constexpr std::array<std::string_view, 6> kTypeNames = {"number",           "truth value",           "text",
                                                        "array of numbers", "array of truth values", "array of texts"};
std::string_view name_of(Type type) { return kTypeNames[static_cast<std::size_t>(type)]; }

bool is_array(Type type) { return type >= Type::number_array; }

class TypeCheck {
 public:
  explicit TypeCheck(const Checked& c) : c_(c) {}

  void run() {
    for (const Expression& e : c_.unit.expressions) {
      switch (e.kind) {
        case ExpressionKind::unary:
          require(e.first, e.op == Operator::logical_not ? Type::truth : Type::number, "this operator");
          break;
        case ExpressionKind::binary:
          operands(e);
          break;
        case ExpressionKind::index:
          if (const auto type = of(e.first); type && !is_array(*type))
            wrong(e.first, "an array", *type, "what is indexed");
          break;
        case ExpressionKind::cases:
        case ExpressionKind::chances:
          branches(e);
          break;
        case ExpressionKind::name:
          arguments(c_.module.targets[e.use], e.arguments, e.location, c_.unit.name(e.name));
          break;
        case ExpressionKind::number:
        case ExpressionKind::text:
        case ExpressionKind::truth:
        case ExpressionKind::array:
        case ExpressionKind::range:
        case ExpressionKind::component_map:
          break;
      }
    }
    for (const Successor& s : c_.unit.successors)
      if (s.kind != SuccessorKind::steps) conditions(s.branches, s.kind == SuccessorKind::chances);
    for (const BlockItem& item : c_.unit.items)
      if (item.kind == ItemKind::sized) {
        require(item.value, Type::number, "a size");
        if (item.depth != kNone) require(item.depth, Type::number, "a depth");
      }
    for (const Call& call : c_.unit.calls)
      arguments(c_.module.targets[call.use], call.arguments, call.location, c_.unit.name(call.name));
  }

 private:
  std::optional<Type> of(NodeId id) const { return c_.module.types[id]; }

  bool is_word(NodeId id) const {
    const Expression& e = c_.expression(id);
    return e.kind == ExpressionKind::name && c_.module.targets[e.use].kind == TargetKind::word;
  }

  void wrong(NodeId id, std::string_view wanted, Type found, std::string_view where) const {
    c_.tell(
        Severity::error, "type", c_.expression(id).location,
        std::string(where) + " takes " + std::string(wanted) + ", not " +
            (found == Type::number_array || found == Type::truth_array || found == Type::text_array ? "an " : "a ") +
            std::string(name_of(found)));
  }

  void require(NodeId id, Type wanted, std::string_view where) const {
    const auto type = of(id);
    if (type && *type != wanted && !(is_array(*type) && wanted == Type::number && where == "this operator"))
      wrong(id, "a " + std::string(name_of(wanted)), *type, where);
  }

  void operands(const Expression& e) const {
    const auto a = of(e.first), b = of(e.second);
    const bool differ = a && b && *a != *b;
    if (e.op == Operator::add) {
      // Texts take anything; numbers and truth values do not add up.
      if (differ && *a != Type::text && *b != Type::text)
        c_.tell(Severity::error, "type", e.location,
                "a " + std::string(name_of(*a)) + " and a " + std::string(name_of(*b)) + " cannot be added");
    } else if (is_arithmetic(e.op)) {
      require_number(e.first);
      require_number(e.second);
    } else if (is_connective(e.op)) {
      require(e.first, Type::truth, "this operator");
      require(e.second, Type::truth, "this operator");
    } else if (is_comparison(e.op) && differ) {
      c_.tell(Severity::error, "type", e.location,
              "a " + std::string(name_of(*a)) + " is compared with a " + std::string(name_of(*b)));
    }
  }

  void require_number(NodeId id) const {
    const auto type = of(id);
    if (!type || *type == Type::number) return;
    if (is_array(*type))
      c_.tell(Severity::error, "type", c_.expression(id).location, "arrays take the operators with a dot: .+ .- .* ./");
    else
      wrong(id, "a number", *type, "this operator");
  }

  void conditions(Range range, bool chances) const {
    for (const Branch& branch : Unit::slice(c_.unit.branches, range))
      if (branch.condition != kNone)
        require(branch.condition, chances ? Type::number : Type::truth, chances ? "a probability" : "a condition");
  }

  void branches(const Expression& e) const {
    conditions(e.branches, e.kind == ExpressionKind::chances);
    std::optional<Type> first;
    for (const Branch& branch : Unit::slice(c_.unit.branches, e.branches)) {
      const auto type = of(branch.result);
      if (!type) continue;
      if (!first) first = type;
      if (*type != *first)
        c_.tell(Severity::error, "type", c_.expression(branch.result).location,
                "this branch gives a " + std::string(name_of(*type)) + ", the first a " + std::string(name_of(*first)));
    }
  }

  /// Whether a value of known type can stand where a signature has this letter.
  bool can_be(const Signature::Item& item, NodeId id) const {
    if (is_word(id)) return true;  // The resolver knows which words fit.
    const auto type = of(id);
    if (!type) return true;
    switch (item.type) {
      case 'n':
      case 'r':
        return *type == Type::number || (!item.words.empty() && *type == Type::text);
      case 'b':
        return *type == Type::truth;
      case 's':
        return *type == Type::text;
      case 'N':
        return *type == Type::number_array;
      case 'B':
        return *type == Type::truth_array;
      case 'S':
        return *type == Type::text_array;
      case 'v':
        return !is_array(*type);
      case 'V':
        return is_array(*type);
      case 'w':
        return *type == Type::text;
      default:
        return true;
    }
  }

  static std::string_view letter_name(char letter) {
    switch (letter) {
      case 'n':
      case 'r':
        return "a number";
      case 'b':
        return "a truth value";
      case 's':
        return "a text";
      case 'N':
        return "an array of numbers";
      case 'B':
        return "an array of truth values";
      case 'S':
        return "an array of texts";
      case 'V':
        return "an array";
      case 'v':
        return "a single value";
      case 'w':
        return "a word";
      default:
        return "another value";
    }
  }

  void arguments(const Target& target, Range range, Location location, std::string_view name) const {
    const auto all = Unit::slice(c_.unit.arguments, range);
    if (all.empty()) return;
    if (target.kind == TargetKind::operation || target.kind == TargetKind::function) {
      // The signature that goes on fitting longest says what is wrong.
      std::size_t furthest = 0;
      char wanted = 0;
      for (const Signature& s : signatures(built_ins()[target.index])) {
        if (all.size() < s.least || all.size() > s.most) continue;
        std::size_t a = 0;
        while (a < all.size() && can_be(s.item(a), all[a].value)) ++a;
        if (a == all.size()) return;
        if (wanted == 0 || a > furthest) {
          furthest = a;
          wanted = s.item(a).type;
        }
      }
      if (wanted != 0)
        wrong(all[furthest].value, letter_name(wanted), *of(all[furthest].value),
              std::string(name) + ": argument " + std::to_string(furthest + 1));
      return;
    }
    if ((target.kind != TargetKind::rule && target.kind != TargetKind::own_function) || target.count == 0) return;
    for (std::uint32_t i = 0; i < target.count; ++i) {
      const Definition& called = c_.program.definitions[c_.program.candidates[target.index + i]];
      bool fits = true;
      for (std::size_t a = 0; fits && a < all.size(); ++a) {
        const auto type = of(all[a].value);
        fits = !type || !called.parameter_types[a] || *type == *called.parameter_types[a];
      }
      if (fits) return;
    }
    c_.tell(Severity::warning, "type", location,
            target.count == 1 ? "an argument is of another type than its parameter is used as"
                              : "no declaration of this name takes arguments of these types",
            name);
  }

  const Checked& c_;
};

}  // namespace

void check_types(const Checked& c) { TypeCheck(c).run(); }

void check_overrides(const Program& program, std::vector<Diagnostic>& told) {
  for (const Slot& slot : program.slots) {
    const Definition& definition = program.definitions[slot.definition];
    if (slot.value == kNone || definition.module == slot.module || !definition.result) continue;
    const Module& importer = program.modules[slot.module];
    const auto given = importer.types[slot.value];
    if (!given || *given == *definition.result) continue;
    told.push_back(
        {Severity::error,
         "type",
         importer.unit->expressions[slot.value].location,
         "this attribute is a " + std::string(name_of(*definition.result)) + ", not a " + std::string(name_of(*given)),
         slot.name,
         {}});
  }
}

}  // namespace blockrand::grammar::detail
