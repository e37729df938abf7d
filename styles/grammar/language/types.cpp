// Types as far as they are known without running (docs/rule_language.md §1.3, 9), and the order in which attributes are
// evaluated.
#include <algorithm>

#include "styles/grammar/language/program_building.h"

namespace blockrand::grammar::detail {

namespace {

using Known = std::optional<Type>;

Known type_of_letter(char letter) {
  switch (letter) {
    case 'n':
    case 'r':
      return Type::number;
    case 'b':
      return Type::truth;
    case 's':
      return Type::text;
    case 'N':
      return Type::number_array;
    case 'B':
      return Type::truth_array;
    case 'S':
      return Type::text_array;
    default:
      return std::nullopt;
  }
}

bool is_array(Type type) { return type >= Type::number_array; }
Type array_of(Type type) { return is_array(type) ? type : static_cast<Type>(static_cast<int>(type) + 3); }
Type element_of(Type type) { return is_array(type) ? static_cast<Type>(static_cast<int>(type) - 3) : type; }

bool can_be(char letter, const Known& type) {
  if (!type || letter == 'a' || letter == 'e' || letter == 'i') return true;
  if (letter == 'v') return !is_array(*type);
  if (letter == 'V') return is_array(*type);
  if (letter == 'w') return *type == Type::text;
  return type_of_letter(letter) == type;
}

/// Types of one module; run in rounds, since functions refer to one another.
class Inference {
 public:
  Inference(Program& program, std::uint32_t m, const std::vector<std::uint32_t>& definitions)
      : program_(program), module_(program.modules[m]), unit_(*module_.unit) {
    module_.types.assign(unit_.expressions.size(), std::nullopt);
    owners_.assign(unit_.expressions.size(), kNone);
    for (std::size_t d = unit_.declarations.size(); d-- > 0;) {
      const Range own = unit_.declarations[d].own_expressions;
      std::fill_n(owners_.begin() + own.first, own.count, static_cast<NodeId>(d));
    }
    definitions_.resize(unit_.declarations.size());
    for (const std::uint32_t i : definitions) definitions_[program.definitions[i].declaration].push_back(i);
  }

  bool round() {
    changed_ = false;
    for (NodeId e = 0; e < unit_.expressions.size(); ++e) {
      if (module_.types[e]) continue;
      module_.types[e] = type(e);
      changed_ = changed_ || module_.types[e];
    }
    for (NodeId d = 0; d < unit_.declarations.size(); ++d) {
      const NodeId value = unit_.declarations[d].value;
      if (value == kNone || !module_.types[value]) continue;
      for (const std::uint32_t definition : definitions_[d]) {
        changed_ = changed_ || !program_.definitions[definition].result;
        program_.definitions[definition].result = module_.types[value];
      }
    }
    expect_types();
    return changed_;
  }

 private:
  Known type(NodeId id) const {
    const Expression& e = unit_.expressions[id];
    const auto of = [&](NodeId child) { return module_.types[child]; };
    switch (e.kind) {
      case ExpressionKind::number:
      case ExpressionKind::range:
        return Type::number;
      case ExpressionKind::text:
        return Type::text;
      case ExpressionKind::truth:
        return Type::truth;
      case ExpressionKind::name:
        return type_of_name(id, e);
      case ExpressionKind::unary:
        return e.op == Operator::logical_not && !of(e.first) ? Known(Type::truth) : of(e.first);
      case ExpressionKind::binary:
        return type_of_binary(e);
      case ExpressionKind::index: {
        if (!of(e.first)) return std::nullopt;
        for (const NodeId item : Unit::slice(unit_.expression_lists, e.list)) {
          if (unit_.expressions[item].kind == ExpressionKind::range) return of(e.first);
          if (!of(item)) return std::nullopt;
          if (is_array(*of(item))) return of(e.first);
        }
        return element_of(*of(e.first));
      }
      case ExpressionKind::array:
        for (const Range row : Unit::slice(unit_.rows, e.rows))
          for (const NodeId item : Unit::slice(unit_.expression_lists, row))
            if (of(item)) return array_of(*of(item));
        return std::nullopt;
      case ExpressionKind::cases:
      case ExpressionKind::chances:
        for (const Branch& branch : Unit::slice(unit_.branches, e.branches))
          if (of(branch.result)) return of(branch.result);
        return std::nullopt;
      case ExpressionKind::component_map:
        for (const ComponentValue& value : Unit::slice(unit_.component_values, e.component_values))
          if (of(value.value)) return array_of(*of(value.value));
        return std::nullopt;
    }
    return std::nullopt;
  }

  Known type_of_binary(const Expression& e) const {
    const Known a = module_.types[e.first], b = module_.types[e.second];
    switch (e.op) {
      case Operator::add:
        if ((a && *a == Type::text) || (b && *b == Type::text)) return Type::text;
        return a && b && *a == *b ? a : std::nullopt;
      case Operator::subtract:
      case Operator::multiply:
      case Operator::divide:
      case Operator::modulo:
        if ((a && is_array(*a)) || (b && is_array(*b))) return std::nullopt;
        return Type::number;
      case Operator::each_add:
      case Operator::each_subtract:
      case Operator::each_multiply:
      case Operator::each_divide:
      case Operator::each_modulo:
        if (a && is_array(*a)) return a;
        if (b && is_array(*b)) return b;
        return a && b ? a : std::nullopt;
      case Operator::each_equal:
      case Operator::each_not_equal:
      case Operator::each_less:
      case Operator::each_less_equal:
      case Operator::each_greater:
      case Operator::each_greater_equal:
      case Operator::each_and:
      case Operator::each_or:
        if ((a && is_array(*a)) || (b && is_array(*b))) return Type::truth_array;
        return a && b ? Known(Type::truth) : std::nullopt;
      case Operator::none:
      case Operator::negate:
      case Operator::plus:
      case Operator::logical_not:
      case Operator::equal:
      case Operator::not_equal:
      case Operator::less:
      case Operator::less_equal:
      case Operator::greater:
      case Operator::greater_equal:
      case Operator::logical_and:
      case Operator::logical_or:
        break;
    }
    return Type::truth;
  }

  Known type_of_name(NodeId id, const Expression& e) const {
    const Target& target = module_.targets[e.use];
    switch (target.kind) {
      case TargetKind::local:
        return type_of_local(owners_[id], target.index);
      case TargetKind::attribute:
        return program_.definitions[program_.slots[target.index].definition].result;
      case TargetKind::own_function: {
        Known common = program_.definitions[program_.candidates[target.index]].result;
        for (std::uint32_t i = 1; i < target.count; ++i)
          if (program_.definitions[program_.candidates[target.index + i]].result != common) return std::nullopt;
        return common;
      }
      case TargetKind::shape_attribute:
        return type_of_letter(signatures(built_ins()[target.index]).front().result);
      case TargetKind::function: {
        Known common;
        bool first = true;
        const auto arguments = Unit::slice(unit_.arguments, e.arguments);
        for (const Signature& s : signatures(built_ins()[target.index])) {
          if (arguments.size() < s.least || arguments.size() > s.most) continue;
          bool possible = true;
          for (std::size_t a = 0; a < arguments.size(); ++a) {
            const Signature::Item& item = s.item(a);
            possible =
                possible && (is_word(arguments[a].value) ? !item.words.empty() || item.type == 'e' || item.type == 'a'
                                                         : can_be(item.type, module_.types[arguments[a].value]));
          }
          if (!possible) continue;
          const Known result = type_of_letter(s.result);
          if (!first && result != common) return std::nullopt;
          common = result;
          first = false;
        }
        return common;
      }
      case TargetKind::leaf:
      case TargetKind::unknown:
      case TargetKind::operation:
      case TargetKind::word:
      case TargetKind::rule:
      case TargetKind::extension:
        break;
    }
    return std::nullopt;
  }

  bool is_word(NodeId id) const {
    const Expression& e = unit_.expressions[id];
    return e.kind == ExpressionKind::name && module_.targets[e.use].kind == TargetKind::word;
  }

  Known type_of_local(NodeId owner, std::uint32_t place) const {
    if (owner == kNone) return std::nullopt;
    const Declaration& declaration = unit_.declarations[owner];
    if (place >= declaration.parameters.count)
      return module_.types[unit_.parameters[declaration.bindings.first + place - declaration.parameters.count].value];
    if (definitions_[owner].empty()) return std::nullopt;
    return program_.definitions[definitions_[owner].front()].parameter_types[place];
  }

  /// A parameter's type from how it is used.
  void expect(NodeId id, const Known& type) {
    if (id == kNone || !type || module_.types[id]) return;
    const Expression& e = unit_.expressions[id];
    if (e.kind != ExpressionKind::name || owners_[id] == kNone) return;
    const Target& target = module_.targets[e.use];
    if (target.kind != TargetKind::local || target.index >= unit_.declarations[owners_[id]].parameters.count) return;
    for (const std::uint32_t definition : definitions_[owners_[id]]) {
      Known& known = program_.definitions[definition].parameter_types[target.index];
      if (known) continue;
      known = type;
      changed_ = true;
    }
  }

  void expect_types() {
    for (const Expression& e : unit_.expressions) {
      switch (e.kind) {
        case ExpressionKind::unary:
          expect(e.first, e.op == Operator::logical_not ? Type::truth : Type::number);
          break;
        case ExpressionKind::binary:
          expect_operands(e);
          break;
        case ExpressionKind::index:
          for (const NodeId item : Unit::slice(unit_.expression_lists, e.list)) expect(item, Type::number);
          break;
        case ExpressionKind::cases:
        case ExpressionKind::chances:
          for (const Branch& branch : Unit::slice(unit_.branches, e.branches))
            expect(branch.condition, e.kind == ExpressionKind::cases ? Type::truth : Type::number);
          break;
        case ExpressionKind::name:
          expect_arguments(module_.targets[e.use], e.arguments);
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
    for (const Successor& s : unit_.successors)
      for (const Branch& branch : Unit::slice(unit_.branches, s.branches))
        expect(branch.condition, s.kind == SuccessorKind::cases ? Type::truth : Type::number);
    for (const BlockItem& item : unit_.items) {
      if (item.kind == ItemKind::sized) expect(item.value, Type::number);
      if (item.kind == ItemKind::sized) expect(item.depth, Type::number);
    }
    for (const Call& call : unit_.calls) expect_arguments(module_.targets[call.use], call.arguments);
  }

  void expect_operands(const Expression& e) {
    if (is_comparison(e.op)) {
      expect(e.first, module_.types[e.second]);
      expect(e.second, module_.types[e.first]);
    } else if (is_connective(e.op)) {
      expect(e.first, Type::truth);
      expect(e.second, Type::truth);
    } else if (is_arithmetic(e.op) && e.op != Operator::add) {  // texts add too
      expect(e.first, Type::number);
      expect(e.second, Type::number);
    }
  }

  void expect_arguments(const Target& target, Range range) {
    const auto arguments = Unit::slice(unit_.arguments, range);
    if (arguments.empty()) return;
    if ((target.kind == TargetKind::rule || target.kind == TargetKind::own_function) && target.count == 1) {
      const Definition& called = program_.definitions[program_.candidates[target.index]];
      for (std::size_t a = 0; a < arguments.size(); ++a) expect(arguments[a].value, called.parameter_types[a]);
    }
    if (target.kind != TargetKind::operation && target.kind != TargetKind::function) return;
    for (std::size_t a = 0; a < arguments.size(); ++a) {
      Known common;
      bool first = true, differs = false;
      for (const Signature& s : signatures(built_ins()[target.index])) {
        if (arguments.size() < s.least || arguments.size() > s.most) continue;
        const Known type = type_of_letter(s.item(a).type);
        differs = differs || (!first && type != common);
        common = type;
        first = false;
      }
      if (!differs) expect(arguments[a].value, common);
    }
  }

  Program& program_;
  Module& module_;
  const Unit& unit_;
  std::vector<NodeId> owners_;
  std::vector<std::vector<std::uint32_t>> definitions_;  ///< by declaration
  bool changed_ = false;
};

/// Puts slots after those that they read; also through functions.
class SlotOrder {
 public:
  explicit SlotOrder(Program& program)
      : program_(program), slot_state_(program.slots.size(), 0), function_state_(program.definitions.size(), 0) {}

  void run() {
    for (std::uint32_t s = 0; s < program_.slots.size(); ++s) visit(s);
    for (const std::uint32_t s : order_) {
      const std::uint32_t root = program_.modules[home(s)].dynamic_root;
      (root == kNone ? program_.slot_order : program_.modules[root].dynamic_slots).push_back(s);
    }
  }

 private:
  struct Step {
    bool slot = true;
    std::uint32_t id = 0;
    std::vector<std::pair<bool, std::uint32_t>> needs;  ///< (slot?, id)
    bool chooses = false;  ///< its value depends on a condition or a draw: not all needs are met every time
    std::size_t next = 0;
  };

  std::uint32_t home(std::uint32_t slot) const { return program_.definitions[program_.slots[slot].definition].module; }

  void needs_of(std::uint32_t module, Range expressions, Step& step) const {
    const Unit& unit = program_.unit(module);
    for (const Expression& e : Unit::slice(unit.expressions, expressions)) {
      step.chooses =
          step.chooses || e.kind == ExpressionKind::cases || e.kind == ExpressionKind::chances ||
          (e.kind == ExpressionKind::binary && (e.op == Operator::logical_and || e.op == Operator::logical_or));
      if (e.kind != ExpressionKind::name) continue;
      const Target& target = program_.modules[module].targets[e.use];
      if (target.kind == TargetKind::attribute) step.needs.emplace_back(true, target.index);
      if (target.kind == TargetKind::own_function)
        for (std::uint32_t i = 0; i < target.count; ++i)
          step.needs.emplace_back(false, program_.candidates[target.index + i]);
    }
  }

  Step begin(bool slot, std::uint32_t id) const {
    Step step;
    step.slot = slot;
    step.id = id;
    if (!slot) {
      const Definition& d = program_.definitions[id];
      needs_of(d.module, program_.declaration(d).own_expressions, step);
      return step;
    }
    const Slot& s = program_.slots[id];
    if (s.source_slot != kNone) {
      step.needs.emplace_back(true, s.source_slot);
      return step;
    }
    const Definition& d = program_.definitions[s.definition];
    if (s.module == d.module) {
      needs_of(d.module, program_.declaration(d).own_expressions, step);
      return step;
    }
    for (const Override& o : program_.unit(s.module).overrides)
      if (o.kind == OverrideKind::attribute && o.value == s.value) needs_of(s.module, o.own_expressions, step);
    return step;
  }

  void visit(std::uint32_t first) {
    if (slot_state_[first] != 0) return;
    std::vector<Step> path;
    slot_state_[first] = 1;
    path.push_back(begin(true, first));
    while (!path.empty()) {
      Step& step = path.back();
      if (step.next == step.needs.size()) {
        (step.slot ? slot_state_ : function_state_)[step.id] = 2;
        if (step.slot) order_.push_back(step.id);
        path.pop_back();
        continue;
      }
      const auto [slot, id] = step.needs[step.next++];
      char& state = (slot ? slot_state_ : function_state_)[id];
      if (state == 0) {
        state = 1;
        path.push_back(begin(slot, id));
      } else if (state == 1 && slot) {
        tell_cycle(path, id);
      }
    }
  }

  void tell_cycle(const std::vector<Step>& path, std::uint32_t slot) {
    Slot& s = program_.slots[slot];
    const Definition& d = program_.definitions[s.definition];
    // An override may read the default that it replaces (docs/rule_language.md §1.5, 3).
    if (path.back().slot && path.back().id == slot && s.module != d.module) {
      s.reads_itself = true;
      return;
    }
    // Where a choice lies on the way round, published files count on the other branch: it is told when it happens.
    bool chooses = false;
    for (auto step = path.rbegin(); step != path.rend() && !chooses; ++step) {
      chooses = step->chooses;
      if (step->slot && step->id == slot) break;
    }
    program_.diagnostics.push_back(
        {chooses ? Severity::warning : Severity::error,
         "attribute_cycle",
         program_.declaration(d).location,
         chooses ? "the value of this attribute can depend on itself" : "the value of this attribute depends on itself",
         s.name,
         {}});
  }

  Program& program_;
  std::vector<char> slot_state_, function_state_;  ///< 0 not seen, 1 on the path, 2 done
  std::vector<std::uint32_t> order_;
};

}  // namespace

void infer_types(Program& program) {
  std::vector<std::vector<std::uint32_t>> definitions(program.modules.size());
  for (std::uint32_t i = 0; i < program.definitions.size(); ++i)
    definitions[program.definitions[i].module].push_back(i);
  std::vector<Inference> modules;
  modules.reserve(program.modules.size());
  for (std::uint32_t m = 0; m < program.modules.size(); ++m) modules.emplace_back(program, m, definitions[m]);
  // What goes through more calls than this stays unknown, which is never wrong.
  constexpr int kRounds = 6;
  for (int i = 0; i < kRounds; ++i) {
    bool changed = false;
    for (Inference& module : modules) changed = module.round() || changed;
    if (!changed) return;
  }
}

void order_slots(Program& program) { SlotOrder(program).run(); }

}  // namespace blockrand::grammar::detail
