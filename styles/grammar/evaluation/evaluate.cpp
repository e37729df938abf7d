// Expressions: names, operators, cases, chances, arrays (docs/rule_language.md §1.2, §1.4).
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/base/random.h"
#include "styles/grammar/evaluation/arrays.h"
#include "styles/grammar/evaluation/run.h"
#include "styles/grammar/language/value_text.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::grammar {
namespace {

/// Bytes of stack that expressions may take: half of what a thread has by default.
constexpr std::ptrdiff_t kMostStack = 4 << 20;

}  // namespace

FunctionContext Run::function_context(Place& place) {
  return {place.shape->seed, &place.shape->draws, options_.files, &warnings_};
}

void Run::take_warnings(const Location& location) {
  for (std::string& warning : warnings_) tell(Severity::warning, "value", location, std::move(warning));
  warnings_.clear();
}

bool Run::too_deep(const Location& location) {
  const char here = 0;
  const std::ptrdiff_t used = stack_start_ - &here;
  if (function_depth_ < options_.limits.function_depth && (used < 0 ? -used : used) < kMostStack) return false;
  tell(Severity::error, "function_depth", location,
       "functions call each other more than " + std::to_string(function_depth_) + " deep; 0 is taken");
  return true;
}

Value Run::evaluate(NodeId id, Place& place) {
  const Expression& e = program_.unit(place.module).expressions[id];
  switch (e.kind) {
    case ExpressionKind::number:
      return e.number;
    case ExpressionKind::text:
      return program_.unit(place.module).texts[e.text];
    case ExpressionKind::truth:
      return e.number != 0;
    case ExpressionKind::name:
      return evaluate_name(e, place);
    case ExpressionKind::unary:
    case ExpressionKind::binary:
      return scalar_of_operator(e, place).value();
    case ExpressionKind::index:
      return evaluate_index(e, place);
    case ExpressionKind::array:
      return evaluate_array(e, place);
    case ExpressionKind::range:
      return evaluate_index_part(id, place);
    case ExpressionKind::cases:
      return evaluate_cases(e, place);
    case ExpressionKind::chances:
      return evaluate_chances(e, place);
    case ExpressionKind::component_map:
      return evaluate_component_map(e, place);
  }
  return 0.0;
}

Scalar Scalar::of(Value&& value) {
  if (const auto* number = std::get_if<double>(&value)) return of(*number);
  if (const auto* truth = std::get_if<bool>(&value)) return of(*truth);
  Scalar out;
  out.type = type_of(value);
  out.other.emplace(std::move(value));
  return out;
}

Value Scalar::value() && {
  if (type == Type::number) return number;
  if (type == Type::truth) return truth;
  return std::move(*other);
}

Scalar Run::scalar(NodeId id, Place& place) {
  const Expression& e = program_.unit(place.module).expressions[id];
  switch (e.kind) {
    case ExpressionKind::number:
      return Scalar::of(e.number);
    case ExpressionKind::truth:
      return Scalar::of(e.number != 0);
    case ExpressionKind::name: {
      if (const Value* known = known_value(e, place)) {
        if (const auto* number = std::get_if<double>(known)) return Scalar::of(*number);
        if (const auto* truth = std::get_if<bool>(known)) return Scalar::of(*truth);
        return Scalar::of(Value(*known));
      }
      if (e.use != kNone)
        if (const Target& found = target(place.module, e.use); found.kind == TargetKind::own_function)
          return call_own(e, found, place);
      return Scalar::of(evaluate_name(e, place));
    }
    case ExpressionKind::unary:
    case ExpressionKind::binary:
      return scalar_of_operator(e, place);
    case ExpressionKind::cases:
      for (const Branch& branch : Unit::slice(program_.unit(place.module).branches, e.branches))
        if (branch.condition == kNone || condition(branch.condition, place)) return scalar(branch.result, place);
      return Scalar::of(0.0);
    case ExpressionKind::text:
    case ExpressionKind::index:
    case ExpressionKind::array:
    case ExpressionKind::range:
    case ExpressionKind::chances:
    case ExpressionKind::component_map:
      break;
  }
  return Scalar::of(evaluate(id, place));
}

Scalar Run::scalar_of_operator(const Expression& e, Place& place) {
  if (e.op == Operator::logical_and || e.op == Operator::logical_or) {
    const bool left = condition(e.first, place);
    if (left == (e.op == Operator::logical_or)) return Scalar::of(left);
    return Scalar::of(condition(e.second, place));
  }
  if (is_comparison(e.op))
    if (const Expression& second = program_.unit(place.module).expressions[e.second];
        second.kind == ExpressionKind::text)
      if (const Value* first = known_value(program_.unit(place.module).expressions[e.first], place))
        if (const auto* text = std::get_if<std::string>(first))
          return Scalar::of(compare(e.op, *text, program_.unit(place.module).texts[second.text]));
  Scalar left = scalar(e.first, place);
  if (e.kind == ExpressionKind::unary) {
    if (left.type == Type::truth && e.op == Operator::logical_not) return Scalar::of(!left.truth);
    if (left.type == Type::number && e.op != Operator::logical_not)
      return Scalar::of((e.op == Operator::negate ? -1 : 1) * left.number);
    auto result = apply_unary(e.op, std::move(left).value());
    if (result) return Scalar::of(std::move(*result));
    tell(Severity::error, "type", e.location, std::move(result.error()));
    return Scalar::of(0.0);
  }
  Scalar right = scalar(e.second, place);
  if (left.type == Type::number && right.type == Type::number) {
    if (is_arithmetic(e.op)) return Scalar::of(calculate(e.op, left.number, right.number));
    if (is_comparison(e.op)) return Scalar::of(compare(e.op, left.number, right.number));
  }
  auto result = apply_binary(e.op, std::move(left).value(), std::move(right).value());
  if (result) return Scalar::of(std::move(*result));
  tell(Severity::error, "type", e.location, std::move(result.error()));
  return Scalar::of(0.0);
}

Value Run::evaluate_index_part(NodeId id, Place& place) {
  const Expression& e = program_.unit(place.module).expressions[id];
  if (e.kind != ExpressionKind::range) return evaluate(id, place);
  const double base = number(e.first, place);
  const double step = e.second == kNone ? 1 : number(e.second, place);
  const double limit = number(e.third, place);
  auto result = make_range(base, step, limit);
  if (result) return std::move(*result);
  tell(Severity::error, "value", e.location, std::move(result.error()));
  return NumberArray{};
}

Value Run::evaluate_index(const Expression& e, Place& place) {
  const auto list = Unit::slice(program_.unit(place.module).expression_lists, e.list);
  // Arrays are not copied for one of their elements.
  const Expression& named = program_.unit(place.module).expressions[e.first];
  if (list.size() == 1 && known_value(named, place)) {
    const Value index = evaluate_index_part(list[0], place);
    auto result = index_value(*known_value(named, place), index);
    if (result) return std::move(*result);
    tell(Severity::error, "type", e.location, std::move(result.error()));
    return 0.0;
  }
  const Value array = evaluate(e.first, place);
  if (list.empty()) return array;
  const Value first = evaluate_index_part(list[0], place);
  auto result =
      list.size() > 1 ? index_value(array, first, evaluate_index_part(list[1], place)) : index_value(array, first);
  if (result) return std::move(*result);
  tell(Severity::error, "type", e.location, std::move(result.error()));
  return 0.0;
}

Value Run::evaluate_array(const Expression& e, Place& place) {
  const Unit& unit = program_.unit(place.module);
  std::vector<std::vector<Value>> rows;
  for (const Range row : Unit::slice(unit.rows, e.rows)) {
    rows.emplace_back();
    for (const NodeId item : Unit::slice(unit.expression_lists, row))
      rows.back().push_back(evaluate_index_part(item, place));
  }
  auto result = make_array(rows);
  if (result) return std::move(*result);
  tell(Severity::error, "type", e.location, std::move(result.error()));
  return NumberArray{};
}

Value Run::evaluate_cases(const Expression& e, Place& place) {
  for (const Branch& branch : Unit::slice(program_.unit(place.module).branches, e.branches))
    if (branch.condition == kNone || condition(branch.condition, place)) return evaluate(branch.result, place);
  return 0.0;
}

double Run::draw_choice(const Location& location, Place& place) {
  if (place.own_text && place.rule != nullptr && place.rule->consistency != Consistency::none) {
    const std::uint64_t where = (std::uint64_t{location.line - place.rule->first_line} << 32) | location.column;
    return static_cast<double>(base::mix64(place.rule->consistent_key ^ base::mix64(where)) >> 11) * 0x1.0p-53;
  }
  return function_context(place).draw();
}

std::size_t Run::draw_branch(Range branches, const Location& location, Place& place) {
  const auto all = Unit::slice(program_.unit(place.module).branches, branches);
  const double drawn = draw_choice(location, place) * 100;
  double sum = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].condition == kNone) return i;
    const double share = number(all[i].condition, place);
    if (share > 0) sum += share;
    if (drawn < sum) return i;
  }
  return all.size();
}

Value Run::evaluate_chances(const Expression& e, Place& place) {
  const std::size_t taken = draw_branch(e.branches, e.location, place);
  if (taken >= e.branches.count) return 0.0;
  return evaluate(program_.unit(place.module).branches[e.branches.first + taken].result, place);
}

double Run::number(NodeId id, Place& place) {
  const Expression& e = program_.unit(place.module).expressions[id];
  if (e.kind == ExpressionKind::number) return e.number;
  const Scalar found = scalar(id, place);
  if (found.type == Type::number) return found.number;
  tell(Severity::error, "type", e.location,
       "a number is needed here, not a " + std::string(type_name(found.type)) + "; 0 is taken");
  return 0;
}

bool Run::condition(NodeId id, Place& place) {
  const Scalar found = scalar(id, place);
  if (found.type == Type::truth) return found.truth;
  tell(Severity::error, "type", program_.unit(place.module).expressions[id].location,
       "a truth value is needed here, not a " + std::string(type_name(found.type)));
  return found.type == Type::number && found.number != 0;
}

std::string Run::text(NodeId id, Place& place) {
  Value value = evaluate(id, place);
  if (auto* found = std::get_if<std::string>(&value)) return std::move(*found);
  return value_text(value);
}

std::string_view Run::word(const ArgumentNode& argument, Place& place) {
  const Unit& unit = program_.unit(place.module);
  const Expression& e = unit.expressions[argument.value];
  if (e.kind != ExpressionKind::name || e.use == kNone) return {};
  return target(place.module, e.use).kind == TargetKind::word ? std::string_view(unit.name(e.name))
                                                              : std::string_view{};
}

std::size_t Run::push_arguments(Range range, Place& place) {
  const std::size_t first = locals_.size();
  for (std::uint32_t i = 0; i < range.count; ++i) {
    const ArgumentNode argument = arguments(range, place)[i];
    const std::string_view bare = word(argument, place);
    Value value = bare.empty() ? evaluate(argument.value, place) : Value(std::string(bare));
    locals_.push_back(std::move(value));
  }
  return first;
}

void Run::push_bindings(const Declaration& declaration, Place& place) {
  const auto bindings = Unit::slice(program_.unit(place.module).parameters, declaration.bindings);
  for (const Parameter& binding : bindings) {
    Value value = evaluate(binding.value, place);
    locals_.push_back(std::move(value));
  }
}

const Value* Run::known_value(const Expression& e, const Place& place) const {
  if (e.kind != ExpressionKind::name || e.use == kNone) return nullptr;
  const Target& found = target(place.module, e.use);
  if (found.kind == TargetKind::local) return &locals_[place.frame + found.index];
  if (found.kind == TargetKind::attribute) {
    if (phase_ == nullptr) return &(*place.shape->attributes)[found.index];
    if (phase_->state[found.index] != 2) return nullptr;
    own_ = own_ || phase_->own[found.index];
    return &phase_->values[found.index];
  }
  if (found.kind == TargetKind::unknown) {
    if (source_of_use_.empty()) source_of_use_.resize(program_.modules.size());
    std::vector<const Value*>& of_use = source_of_use_[place.module];
    if (of_use.empty()) of_use.resize(program_.modules[place.module].targets.size());
    const std::string& name = program_.unit(place.module).name(e.name);
    if (of_use[e.use] == nullptr) {
      const auto known = source_values_.find(std::string_view(name));
      if (known != source_values_.end() && known->second) of_use[e.use] = &*known->second;
    }
    if (phase_ != nullptr && of_use[e.use] != nullptr && is_own(name)) own_ = true;
    return of_use[e.use];
  }
  return nullptr;
}

Value Run::evaluate_name(const Expression& e, Place& place) {
  if (e.use == kNone) return 0.0;
  const Target& found = target(place.module, e.use);
  switch (found.kind) {
    case TargetKind::local:
      return locals_[place.frame + found.index];
    case TargetKind::attribute:
      return read_attribute_slot(found.index, place);
    case TargetKind::shape_attribute:
      return read_shape_attribute(e, found.index, place);
    case TargetKind::function:
      return call_function(e, found, place);
    case TargetKind::own_function:
      return call_own(e, found, place).value();
    case TargetKind::word: {
      const std::string& name = program_.unit(place.module).name(e.name);
      if (place.component != nullptr && without_selector(name)) return false;
      if (place.component != nullptr)
        if (const auto selector = selector_of_word(name))
          return selected(*place.component->split, place.component->item, *selector);
      return name;
    }
    case TargetKind::unknown:
      return read_source(e, program_.unit(place.module).name(e.name));
    case TargetKind::leaf:
    case TargetKind::operation:
    case TargetKind::rule:
    case TargetKind::extension:
      break;
  }
  return 0.0;
}

Value Run::read_source(const Expression& e, std::string_view name) {
  if (phase_ != nullptr && is_own(name)) own_ = true;
  auto known = source_values_.find(name);
  if (known == source_values_.end()) {
    std::optional<Value> value;
    if (options_.source) value = options_.source(name);
    if (!value)
      for (const auto& [given, given_value] : options_.attributes)
        if (given == name) value = given_value;
    known = source_values_.emplace(std::string(name), std::move(value)).first;
  }
  if (known->second) return *known->second;
  tell(Severity::error, "unknown_name", e.location, "nothing defines this name; 0 is taken", std::string(name));
  return 0.0;
}

Value Run::read_attribute_slot(std::uint32_t slot, Place& place) {
  if (phase_ != nullptr) {
    if (phase_->state[slot] == 0) evaluate_slot(slot);
    if (phase_->state[slot] == 1) {
      tell(Severity::error, "cycle",
           program_.declaration(program_.definitions[program_.slots[slot].definition]).location,
           "the value of " + program_.slots[slot].name + " depends on itself; 0 is taken", program_.slots[slot].name);
      return 0.0;
    }
    own_ = own_ || phase_->own[slot];
    return phase_->values[slot];
  }
  return (*place.shape->attributes)[slot];
}

namespace {

/// What a name gives that does nothing: the default of the type that it has otherwise.
Value nothing_of(const BuiltIn& entry) {
  const auto all = signatures(entry);
  switch (all.empty() ? 'n' : all.front().result) {
    case 'b':
      return default_value(Type::truth);
    case 's':
      return default_value(Type::text);
    case 'N':
      return default_value(Type::number_array);
    case 'B':
      return default_value(Type::truth_array);
    case 'S':
      return default_value(Type::text_array);
    default:
      return 0.0;
  }
}

}  // namespace

Value Run::read_shape_attribute(const Expression& e, std::uint32_t number, Place& place) {
  own_ = true;
  if (without(number)) return nothing_of(built_ins()[number]);
  if (const auto read = built_in_actions().attributes[number]) return read(*place.shape);
  const std::string_view name = built_ins()[number].name;
  if (name.starts_with("initialShape.")) {
    if (name == "initialShape.name") return options_.shape_name;
    if (name == "initialShape.startRule" || name == "initialShape.symbol") return start_name_;
    // Its origin in the world: where the first edge begins, and how the object's axes are turned.
    const Frame frame = object_in_world(initial_);
    const bool place_asked = name[name.size() - 2] == 'p';
    return component(place_asked ? frame.origin : angles_of_axes(frame.axes), name.back() - 'x');
  }
  if (name == "uid") return static_cast<double>(place.rule != nullptr ? place.rule->node : 0);
  // A name below "material." that the table does not list.
  const std::string& written = program_.unit(place.module).name(e.name);
  if (auto value = read_attribute(*place.shape, name.empty() ? written : std::string(name))) return std::move(*value);
  tell(Severity::error, "unknown_name", e.location, "there is no such attribute; 0 is taken", written);
  return 0.0;
}

Value Run::call_function(const Expression& e, const Target& found, Place& place) {
  if (without(found.index)) return nothing_of(built_ins()[found.index]);
  const BuiltInActions& actions = built_in_actions();
  if (const SpecialFunction special = actions.special_functions[found.index]) {
    own_ = true;
    return (this->*special)(e, place);
  }
  const auto overloads = actions.functions[found.index];
  const std::string_view name = built_ins()[found.index].name;
  if (overloads.empty()) {
    tell(Severity::error, "not_yet", e.location, "this function is not there yet; 0 is taken", std::string(name));
    return 0.0;
  }
  const std::size_t first = push_arguments(e.arguments, place);
  const auto given = std::span<const Value>(locals_).subspan(first);
  const FunctionEntry* entry = choose_overload(overloads, given);
  Value out = 0.0;
  if (entry == nullptr) {
    std::string types;
    for (const Value& value : given) types += (types.empty() ? "" : ", ") + std::string(type_name(type_of(value)));
    tell(Severity::error, "type", e.location, "no function of this name takes (" + types + "); 0 is taken",
         std::string(name));
  } else if (place.own_text && name == "p" && place.rule != nullptr && place.rule->consistency != Consistency::none) {
    out = draw_choice(e.location, place) < std::get<double>(given[0]);
  } else {
    FunctionContext context = function_context(place);
    auto result = call(*entry, given, context);
    if (result)
      out = std::move(*result);
    else
      tell(Severity::error, "value", e.location, std::move(result.error()), std::string(name));
    if (!warnings_.empty()) take_warnings(e.location);
  }
  locals_.resize(first);
  return out;
}

void Run::tell_too_many_calls(const Location& location, const std::string& name) {
  if (std::exchange(told_calls_, true)) return;
  tell(Severity::error, "too_many_calls", location,
       "functions were called, or shapes compared, more than " + std::to_string(options_.limits.calls) +
           " times; 0 is taken from here on",
       name);
}

Scalar Run::call_own(const Expression& e, const Target& found, Place& place) {
  if (too_deep(e.location)) return Scalar::of(0.0);
  if (++calls_ > options_.limits.calls) {
    tell_too_many_calls(e.location, program_.unit(place.module).name(e.name));
    return Scalar::of(0.0);
  }
  const std::size_t first = push_arguments(e.arguments, place);
  const std::uint32_t chosen = choose(program_, found, std::span<const Value>(locals_).subspan(first));
  Scalar out;
  if (chosen == kNone) {
    tell(Severity::error, "type", e.location, "no function of this name takes these arguments; 0 is taken",
         program_.unit(place.module).name(e.name));
  } else {
    const Definition& definition = program_.definitions[chosen];
    const Declaration& declaration = program_.declaration(definition);
    Place inner{.module = definition.module,
                .frame = first,
                .shape = place.shape,
                .rule = place.rule,
                .lineage = place.lineage};
    ++function_depth_;
    push_bindings(declaration, inner);
    if (declaration.value != kNone) out = scalar(declaration.value, inner);
    --function_depth_;
  }
  locals_.resize(first);
  return out;
}

}  // namespace blockrand::grammar
