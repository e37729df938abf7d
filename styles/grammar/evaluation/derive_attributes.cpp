// Values of attributes: from outside, from the importing file, or by their expression
// (docs/rule_language.md §1.4, §1.5, §4.1).
#include <algorithm>
#include <utility>

#include "pipeline/base/random.h"
#include "styles/grammar/evaluation/run.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

/// Names of tags hold ":", names of attributes cannot: building:levels is building__levels
/// (docs/rule_language.md §4.1, 4).
std::string attribute_name(std::string_view name) {
  std::string out;
  for (const char c : name) c == ':' ? out.append("__") : out.append(1, c);
  return out;
}

/// A value from outside in the type that the attribute has. \returns false: it cannot be turned into that
bool turn_into(Type type, Value& value) {
  if (type_of(value) == type) return true;
  if (type == Type::text) {
    value = value_text(value);
    return true;
  }
  if (type == Type::number && type_of(value) == Type::text) {
    const double read = leading_number(std::get<std::string>(value));
    if (read != read) return false;
    value = read;
    return true;
  }
  if (type == Type::number && type_of(value) == Type::truth) {
    value = std::get<bool>(value) ? 1.0 : 0.0;
    return true;
  }
  if (type == Type::truth && type_of(value) == Type::text) {
    const std::string& text = std::get<std::string>(value);
    value = text != "no" && truth_of(text);  // "no" is how OpenStreetMap says false
    return true;
  }
  if (type == Type::truth && type_of(value) == Type::number) {
    value = std::get<double>(value) != 0;
    return true;
  }
  return false;
}

}  // namespace

std::uint32_t find_outside(const Slot& slot, const std::vector<std::pair<std::string, Value>>& attributes) {
  if (slot.constant) return kNone;
  const auto given = std::find_if(attributes.begin(), attributes.end(), [&](const auto& one) {
    return one.first == slot.name ||
           (one.first.find(':') != std::string::npos && attribute_name(one.first) == slot.name);
  });
  return given == attributes.end() ? kNone : static_cast<std::uint32_t>(given - attributes.begin());
}

Value Run::outside_value(std::uint32_t index, bool& found) {
  const Slot& slot = program_.slots[index];
  found = false;
  const std::uint32_t number =
      options_.outside != nullptr ? (*options_.outside)[index] : find_outside(slot, options_.attributes);
  if (number == kNone) return 0.0;
  const auto given = options_.attributes.begin() + number;
  Value value = given->second;
  const Definition& definition = program_.definitions[slot.definition];
  std::optional<Type> type = definition.result;
  if (!type) {  // a literal says its type
    const Declaration& declaration = program_.declaration(definition);
    if (declaration.value != kNone) {
      const Expression& e = program_.unit(definition.module).expressions[declaration.value];
      if (e.kind == ExpressionKind::number) type = Type::number;
      if (e.kind == ExpressionKind::text) type = Type::text;
      if (e.kind == ExpressionKind::truth) type = Type::truth;
    }
  }
  if (type && !turn_into(*type, value)) {
    tell(Severity::warning, "value", program_.declaration(definition).location,
         "the value from outside is no " + std::string(type_name(*type)) + "; the file's own is taken",
         value_text(given->second));
    return 0.0;
  }
  found = true;
  return value;
}

void Run::evaluate_slot(std::uint32_t index) {
  AttributePhase& phase = *phase_;
  if (phase.state[index] != 0) return;
  AttributeMemo* const memo = phase.importer == nullptr ? options_.memo : nullptr;
  if (memo != nullptr) {
    if (memo->values.size() <= index) memo->values.resize(program_.slots.size());
    if (memo->values[index]) {
      phase.values[index] = *memo->values[index];
      phase.state[index] = 2;
      return;
    }
  }
  const bool own_before = std::exchange(own_, false);
  phase.state[index] = 1;
  const Slot& slot = program_.slots[index];
  const Definition& definition = program_.definitions[slot.definition];
  const Declaration& declaration = program_.declaration(definition);
  const bool own = slot.module == definition.module && slot.value == declaration.value;
  bool found = false;
  Value value = 0.0;
  if (phase.outside || own) value = outside_value(index, found);
  if (!found && slot.source_slot != kNone) {
    if (phase.state[slot.source_slot] == 0) evaluate_slot(slot.source_slot);
    own_ = own_ || phase.own[slot.source_slot] || phase.state[slot.source_slot] != 2;
    value = phase.values[slot.source_slot];
    found = true;
  }
  if (!found && slot.value != kNone && !too_deep(declaration.location)) {
    // A stream of random numbers of its own: no attribute disturbs another, nor the shape
    // (docs/rule_language.md §4.1, 3).
    Shape& shape = phase.shape;
    const auto [seed_before, draws_before] = std::pair(shape.seed, shape.draws);
    // @Consistent before an attribute: one value in all derivations of a building, or of a row.
    const Consistency consistency = facts_[slot.definition].consistency;
    shape.seed = base::random_bits(consistency == Consistency::row        ? options_.row_seed
                                   : consistency == Consistency::building ? options_.building_seed
                                                                          : initial_.seed,
                                   0, slot.name);
    shape.draws = 0;
    const std::size_t frame = locals_.size();
    Place place{.module = slot.module, .frame = frame, .shape = &shape};
    if (phase.importer != nullptr && phase.importer->module == slot.module && !own) place.frame = phase.importer->frame;
    ++function_depth_;
    if (slot.reads_itself) {  // h = imp.h + 1: the file's own value first
      Place file{.module = definition.module, .frame = frame, .shape = &shape};
      push_bindings(declaration, file);
      phase.values[index] = declaration.value == kNone ? Value(0.0) : evaluate(declaration.value, file);
      locals_.resize(frame);
      phase.state[index] = 2;
    }
    if (own) push_bindings(declaration, place);
    value = evaluate(slot.value, place);
    --function_depth_;
    locals_.resize(frame);
    if (consistency == Consistency::none && shape.draws > 0) own_ = true;
    shape.seed = seed_before;
    shape.draws = draws_before;
  }
  if (memo != nullptr && !own_) memo->values[index] = value;
  phase.own[index] = own_;
  own_ = own_before || own_;
  phase.values[index] = std::move(value);
  phase.state[index] = 2;
}

void Run::evaluate_attributes() {
  AttributePhase phase;
  phase.values.assign(program_.slots.size(), 0.0);
  phase.state.assign(program_.slots.size(), 0);
  phase.own.assign(program_.slots.size(), false);
  phase.shape = initial_;
  phase_ = &phase;
  for (const std::uint32_t slot : program_.slot_order) evaluate_slot(slot);
  phase_ = nullptr;
  initial_.attributes = std::make_shared<const std::vector<Value>>(std::move(phase.values));
  if (options_.orders_only) return;
  for (const std::uint32_t slot : program_.slot_order)
    if (!program_.slots[slot].constant)
      out_.attributes.emplace_back(program_.slots[slot].name, (*initial_.attributes)[slot]);
  for (const auto& [name, value] : options_.attributes) {
    const std::string wanted = attribute_name(name);
    if (is_engine_prefix(name.substr(0, name.find('.')))) continue;
    if (std::none_of(program_.slots.begin(), program_.slots.end(), [&](const Slot& s) { return s.name == wanted; }))
      tell(Severity::note, "unused_value", {}, "no attribute of this name takes the value from outside", name);
  }
}

void Run::enter_dynamic(std::uint32_t module, Shape& shape, Place& importer) {
  AttributePhase phase;
  phase.values = shape.attributes != nullptr ? *shape.attributes : std::vector<Value>();
  phase.values.resize(program_.slots.size(), 0.0);
  phase.state.assign(program_.slots.size(), 2);
  phase.own.assign(program_.slots.size(), true);
  const std::vector<std::uint32_t>& slots = program_.modules[module].dynamic_slots;
  for (const std::uint32_t slot : slots) phase.state[slot] = 0;
  phase.shape = initial_;
  phase.importer = &importer;
  phase.outside = false;
  AttributePhase* const before = phase_;
  phase_ = &phase;
  for (const std::uint32_t slot : slots) evaluate_slot(slot);
  phase_ = before;
  shape.attributes = std::make_shared<const std::vector<Value>>(std::move(phase.values));
}

void Run::set_slot(Shape& shape, std::uint32_t slot, Value value) {
  auto values = std::make_shared<std::vector<Value>>(*shape.attributes);
  (*values)[slot] = std::move(value);
  shape.attributes = std::move(values);
}

}  // namespace blockrand::grammar
