// The steps of a successor: symbols, operations, brackets, cases, and steps that only tell or set
// (docs/rule_language.md §1.2, §2.0).
#include <cmath>

#include "styles/grammar/evaluation/run.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {

void Run::execute(NodeId id, Work& work, Place& place, bool last) {
  const Unit& unit = program_.unit(place.module);
  const Successor& successor = unit.successors[id];
  switch (successor.kind) {
    case SuccessorKind::cases:
      for (const Branch& branch : Unit::slice(unit.branches, successor.branches))
        if (branch.condition == kNone || condition(branch.condition, place))
          return execute(branch.result, work, place, last);
      return;
    case SuccessorKind::chances: {
      const std::size_t taken = draw_branch(successor.branches, successor.location, place);
      if (taken < successor.branches.count)
        execute(unit.branches[successor.branches.first + taken].result, work, place, last);
      return;
    }
    case SuccessorKind::steps:
      break;
  }
  for (std::uint32_t i = 0; i < successor.steps.count; ++i) {
    const Step& step = unit.steps[successor.steps.first + i];
    if (!work.alive) return;
    switch (step.kind) {
      case StepKind::call:
        execute_call(unit.calls[step.call], work, place, last && i + 1 == successor.steps.count);
        break;
      case StepKind::push: {
        Work inner;
        inner.shape = work.shape;
        inner.base = &work.shape;
        inner.seeds = work.seeds;
        inner.lineage = work.lineage;
        Place there = place;
        there.shape = &inner.shape;
        execute(step.successor, inner, there, true);
        work.seeds = inner.seeds;
        // What was drawn inside the brackets is not drawn again behind them.
        if (inner.shape.seed == work.shape.seed) work.shape.draws = std::max(work.shape.draws, inner.shape.draws);
        work.produced = work.produced || inner.produced;
        break;
      }
      case StepKind::inlined_call:
      case StepKind::inlined:
        tell(Severity::warning, "not_yet", step.location,
             "inline is not there yet: the shapes become children instead of parts of this one", "inline");
        if (step.kind == StepKind::inlined_call)
          execute_call(unit.calls[step.call], work, place, false);
        else
          execute(step.successor, work, place, false);
        break;
    }
  }
}

void Run::execute_call(const Call& call, Work& work, Place& place, bool last) {
  const Target& found = target(place.module, call.use);
  if (found.kind == TargetKind::operation) {
    execute_operation(call, found.index, work, place);
  } else if (found.kind == TargetKind::extension) {
    execute_request(call, work, place, last);
  } else {
    execute_symbol(call, found, work, place, last);
  }
}

void Run::execute_symbol(const Call& call, const Target& found, Work& work, Place& place, bool last) {
  const Unit& unit = program_.unit(place.module);
  work.produced = true;
  if (links_.size() >= options_.limits.shapes) {
    if (!full_)
      tell(Severity::error, "too_many_shapes", call.location,
           "there are more than " + std::to_string(options_.limits.shapes) + " shapes; further ones are left out",
           unit.name(call.name));
    full_ = true;
    return;
  }
  // Made where it will wait; what turns out to be a leaf, or too deep, is taken off again.
  Node& child = next_.emplace_back();
  child.symbol = unit.name(call.name);
  if (call.terminal) child.symbol += '.';
  child.depth = node_->depth + 1;
  child.location = call.location;
  if (found.kind == TargetKind::rule && !call.terminal) {
    const std::size_t first = push_arguments(call.arguments, place);
    child.definition = choose(program_, found, std::span<const Value>(locals_).subspan(first));
    if (child.definition == kNone)
      tell(Severity::warning, "no_rule", call.location,
           "no rule of this name takes these arguments; the shape is a leaf", child.symbol);
    else
      child.arguments.assign(std::make_move_iterator(locals_.begin() + static_cast<std::ptrdiff_t>(first)),
                             std::make_move_iterator(locals_.end()));
    locals_.resize(first);
  } else if (!call.terminal && told_leaves_.insert((std::uint64_t{place.module} << 32) | call.use).second) {
    // Loading has told of these, but not of values that the program gives: it does not know which there are.
    const bool value = is_engine_prefix(std::string_view(child.symbol).substr(0, child.symbol.find('.')));
    tell(Severity::warning, value ? "undefined_symbol" : "no_rule", call.location,
         "there is no rule of this name; the shape is a leaf", child.symbol,
         std::string(nearest_built_in(NameKind::operation, child.symbol)));
  }
  if (child.definition != kNone && child.depth > options_.limits.depth) {
    tell(Severity::error, "depth", call.location,
         "rules follow each other more than " + std::to_string(options_.limits.depth) + " deep; this branch ends here",
         child.symbol);
    next_.pop_back();
    return;
  }
  child.lineage = child_lineage(work);
  const std::uint64_t seed = child_seed(work);
  Location location = call.location;
  const auto number = static_cast<std::uint32_t>(links_.size());
  links_.push_back({node_->number, ordinals_});
  if (last)
    child.shape = std::move(work.shape);
  else
    child.shape = work.shape;
  child.shape.seed = seed;
  child.shape.draws = 0;
  if (child.definition != kNone && found.dynamic_module != kNone)
    enter_dynamic(found.dynamic_module, child.shape, place);
  if (options_.keep_tree)
    out_.tree.push_back({.parent = node_->number,
                         .ordinal = ordinals_,
                         .depth = child.depth,
                         .symbol = child.symbol,
                         .definition = child.definition,
                         .location = location,
                         .shape = child.shape});
  ++ordinals_;
  child.number = number;
  if (child.definition != kNone) return;
  leave_leaf(std::move(child.symbol), std::move(child.shape), location, number, child.lineage);
  next_.pop_back();
}

void Run::execute_request(const Call& call, Work& work, Place& place, bool last) {
  const std::size_t first = push_arguments(call.arguments, place);
  auto order = std::make_shared<ElementRequest>();
  const std::string& name = program_.unit(place.module).name(call.name);
  order->name = name.substr(name.find('.') == std::string::npos ? 0 : name.find('.') + 1);
  order->arguments.assign(std::make_move_iterator(locals_.begin() + static_cast<std::ptrdiff_t>(first)),
                          std::make_move_iterator(locals_.end()));
  order->location = call.location;
  locals_.resize(first);
  work.produced = true;
  const std::uint32_t lineage = child_lineage(work);
  const std::uint64_t seed = child_seed(work);
  Shape shape = last ? std::move(work.shape) : work.shape;
  shape.seed = seed;
  shape.draws = 0;
  leave_leaf(name, std::move(shape), call.location, node_->number, lineage, std::move(order));
}

void Run::evaluate_operation_arguments(const Call& call, Place& place) {
  operands_.clear();
  for (const ArgumentNode& argument : arguments(call.arguments, place)) {
    Argument operand;
    operand.mark = argument.mark;
    const std::string_view bare = word(argument, place);
    if (!bare.empty()) {
      operand.word = bare;
    } else {
      operand.value = evaluate(argument.value, place);
      const Expression& e = program_.unit(place.module).expressions[argument.value];
      if (auto* number = std::get_if<double>(&operand.value); number != nullptr && !std::isfinite(*number)) {
        tell(Severity::warning, "not_finite", e.location, "this is not a finite number; 0 is taken instead");
        *number = 0;
      }
      // sel("front") stands for the word front.
      if (e.kind == ExpressionKind::name && e.use != kNone && type_of(operand.value) == Type::text) {
        const Target& found = target(place.module, e.use);
        if (found.kind == TargetKind::function && built_ins()[found.index].name == "sel")
          operand.word = std::get<std::string>(operand.value);
      }
    }
    operands_.push_back(std::move(operand));
  }
}

void Run::execute_operation(const Call& call, std::uint32_t number, Work& work, Place& place) {
  if (without(number)) return;
  const BuiltInActions& actions = built_in_actions();
  if (const SpecialStep special = actions.special_steps[number]) return (this->*special)(call, work, place);
  const OperationEntry& entry = *actions.operations[number];
  if (built_ins()[number].status == Status::not_yet)
    tell(Severity::warning, "not_yet", call.location,
         "this operation is not there in full: something simple stands in for it", std::string(entry.name));
  // Extruding each face of what was extruded makes six times as many again and again.
  if (mesh_of(work.shape).faces.size() > options_.limits.faces)
    return tell(Severity::error, "too_many_faces", call.location,
                "the shape has more than " + std::to_string(options_.limits.faces) + " faces; it stays as it is",
                std::string(entry.name));
  evaluate_operation_arguments(call, place);
  // offset(d, inside) takes a part: what was there before stays for context queries (docs/rule_language.md §4.6).
  if (recorded_ != nullptr && entry.name == "offset" && operands_.size() > 1) keep_occluder(work.shape, work.lineage);
  const auto given = static_cast<int>(operands_.size());
  if (given < entry.least || given > entry.most)
    return tell(Severity::error, "arguments", call.location,
                "takes " + std::to_string(entry.least) +
                    (entry.most > entry.least ? " to " + std::to_string(entry.most) : std::string()) +
                    " arguments, not " + std::to_string(given) + "; the shape stays as it is",
                std::string(entry.name));
  const auto done = entry.run(work.shape, {*work.base, initial_}, operands_);
  if (!done) tell(Severity::error, "operation", call.location, done.error(), std::string(entry.name));
}

void Run::step_nil(const Call&, Work& work, Place&) { work.alive = false; }

void Run::step_not_yet(const Call& call, Work&, Place& place) {
  tell(Severity::warning, "not_yet", call.location, "this operation is not there yet; the shape stays as it is",
       program_.unit(place.module).name(call.name));
}

void Run::step_set(const Call& call, Work& work, Place& place) {
  const auto given = arguments(call.arguments, place);
  if (given.size() != 2)
    return tell(Severity::error, "arguments", call.location, "set takes a name and a value", "set");
  const Unit& unit = program_.unit(place.module);
  const Expression& name = unit.expressions[given[0].value];
  if (name.kind != ExpressionKind::name || name.use == kNone)
    return tell(Severity::error, "arguments", name.location, "the first argument of set is the name of an attribute");
  Value value = evaluate(given[1].value, place);
  const Target& found = target(place.module, name.use);
  if (found.kind == TargetKind::attribute) return set_slot(work.shape, found.index, std::move(value));
  const auto done = set_attribute(work.shape, unit.name(name.name), value);
  if (!done) tell(Severity::error, "operation", name.location, done.error(), unit.name(name.name));
}

void Run::step_report(const Call& call, Work&, Place& place) {
  const auto given = arguments(call.arguments, place);
  if (given.size() != 2)
    return tell(Severity::error, "arguments", call.location, "report takes a key and a value", "report");
  std::string key = text(given[0].value, place);
  const Value value = evaluate(given[1].value, place);
  const Type type = type_of(value);
  if (type >= Type::number_array)
    return tell(Severity::error, "type", call.location, "report takes a number, a truth value or a text", "report");
  const double counted = type == Type::number  ? std::get<double>(value)
                         : type == Type::truth ? std::get<bool>(value)
                                               : 0;
  Report& report = reports_[{key, type}];
  if (report.count == 0) report = {.key = std::move(key), .type = type, .minimum = counted, .maximum = counted};
  ++report.count;
  report.sum += counted;
  report.minimum = std::min(report.minimum, counted);
  report.maximum = std::max(report.maximum, counted);
}

void Run::step_print(const Call& call, Work&, Place& place) {
  const auto given = arguments(call.arguments, place);
  if (given.size() != 1) return tell(Severity::error, "arguments", call.location, "print takes a value", "print");
  out_.prints.push_back(value_text(evaluate(given[0].value, place)));
}

/// Labels matter to context queries only.
void Run::step_label(const Call& call, Work& work, Place& place) {
  for (const ArgumentNode& argument : arguments(call.arguments, place))
    keep_occluder(work.shape, work.lineage, text(argument.value, place));
}

}  // namespace blockrand::grammar
