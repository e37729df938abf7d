// Operations with blocks: each item runs on pieces or components of the current shape (docs/rule_language.md §2.3 -
// §2.5).
#include <algorithm>
#include <cmath>

#include "styles/grammar/evaluation/run.h"
#include "styles/grammar/language/value_text.h"
#include "styles/grammar/shapes/pieces.h"

namespace blockrand::grammar {

void Run::run_item(NodeId successor, Shape piece, Work& parent, Place& place) {
  parent.produced = true;
  const Unit& unit = program_.unit(place.module);
  const Successor& item = unit.successors[successor];
  if (++pieces_ > options_.limits.pieces)
    return tell(Severity::error, "too_many_pieces", item.location,
                "there are more than " + std::to_string(options_.limits.pieces) + " pieces; further ones are left out");
  const std::uint32_t lineage = child_lineage(parent);
  piece.seed = child_seed(parent);
  piece.draws = 0;
  // What operations relate to is the piece as it was; a lone symbol relates to nothing.
  std::optional<Shape> base;
  const bool single =
      item.kind == SuccessorKind::steps && item.steps.count == 1 && unit.steps[item.steps.first].kind == StepKind::call;
  if (!single || target(place.module, unit.calls[unit.steps[item.steps.first].call].use).kind == TargetKind::operation)
    base = piece;
  Work inner{.shape = std::move(piece), .base = base ? &*base : nullptr, .lineage = lineage};
  Place there = place;
  there.shape = &inner.shape;
  there.lineage = lineage;
  execute(successor, inner, there, true);
  if (inner.alive && !inner.produced)
    leave_leaf(node_->symbol, std::move(inner.shape), item.location, node_->number, lineage);
}

std::vector<SplitItem> Run::split_items(Range range, Place& place, std::vector<NodeId>& successors) {
  const Unit& unit = program_.unit(place.module);
  std::vector<SplitItem> out;
  for (std::uint32_t i = 0; i < range.count; ++i) {
    const BlockItem& item = unit.items[range.first + i];
    SplitItem made;
    if (item.kind == ItemKind::group) {
      const auto inside = split_items(item.items, place, successors);
      made.inside = static_cast<std::int32_t>(inside.size());
      made.repeat = item.repeat;
      if (inside.empty()) continue;
      out.push_back(made);
      out.insert(out.end(), inside.begin(), inside.end());
      continue;
    }
    made.mark = item.mark;
    made.size = item.value == kNone ? 1 : number(item.value, place);
    if (item.value == kNone)
      made.mark = Mark::floating;  // before 2015.0 a size could be left out
                                   // (docs/rule_language.md §1.2)
    if (!std::isfinite(made.size)) {
      tell(Severity::warning, "not_finite", item.location, "this size is not a finite number; 0 is taken instead");
      made.size = 0;
    }
    made.rule = static_cast<std::int32_t>(successors.size());
    successors.push_back(item.successor);
    out.push_back(made);
  }
  return out;
}

void Run::step_split(const Call& call, Work& work, Place& place) {
  if (call.block == kNone) return tell(Severity::error, "arguments", call.location, "split needs a block", "split");
  evaluate_operation_arguments(call, place);
  const Block& block = program_.unit(place.module).blocks[call.block];
  std::string axis;
  bool adjust = true, unit_space = false;
  int set = 0;
  for (const Argument& operand : operands_) {
    if (operand.word == "noAdjust" || operand.word == "adjust")
      adjust = operand.word == "adjust";
    else if (operand.word == "unitSpace" || operand.word == "uvSpace")
      unit_space = operand.word == "unitSpace";
    else if (!operand.word.empty())
      axis = operand.word;
    else if (const auto* number = std::get_if<double>(&operand.value))
      set = static_cast<int>(std::clamp(*number, -1.0, 99.0));
  }
  work.produced = true;
  std::vector<NodeId> successors;
  const auto items = split_items(block.items, place, successors);
  std::vector<SplitPiece> pieces;
  std::vector<Shape> shapes;
  if (axis == "u" || axis == "v") {
    const auto range = uv_range(work.shape, axis == "v", unit_space, set);
    if (!range) return tell(Severity::error, "operation", call.location, range.error(), "split");
    pieces = split_sizes(items, block.repeat, range->length());
    shapes = split_uv(work.shape, axis == "v", set, *range, pieces);
  } else if (axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z') {
    pieces = split_sizes(items, block.repeat, split_length(work.shape, axis[0] - 'x'));
    shapes = split_shape(work.shape, axis[0] - 'x', pieces, adjust);
  } else {
    return tell(Severity::error, "arguments", call.location, "split takes x, y, z, u or v", axis);
  }
  for (std::size_t i = 0; i < shapes.size() && i < pieces.size(); ++i)
    run_item(successors[static_cast<std::size_t>(pieces[i].rule)], std::move(shapes[i]), work, place);
}

void Run::step_split_area(const Call& call, Work& work, Place& place) {
  if (call.block == kNone)
    return tell(Severity::error, "arguments", call.location, "splitArea needs a block", "splitArea");
  evaluate_operation_arguments(call, place);
  const Block& block = program_.unit(place.module).blocks[call.block];
  int axis = -1;
  bool adjust = true;
  for (const Argument& operand : operands_) {
    if (operand.word.size() == 1 && operand.word[0] >= 'x' && operand.word[0] <= 'z') axis = operand.word[0] - 'x';
    if (operand.word == "noAdjust") adjust = false;
  }
  if (axis < 0) return tell(Severity::error, "arguments", call.location, "splitArea takes x, y or z", "splitArea");
  work.produced = true;
  std::vector<NodeId> successors;
  const auto items = split_items(block.items, place, successors);
  const auto pieces = split_sizes(items, block.repeat, split_area_total(work.shape));
  auto shapes = split_area(work.shape, axis, pieces, adjust);
  for (std::size_t i = 0; i < shapes.size() && i < pieces.size(); ++i)
    run_item(successors[static_cast<std::size_t>(pieces[i].rule)], std::move(shapes[i]), work, place);
}

bool Run::mentions_selector(NodeId id, const Place& place) const {
  const Unit& unit = program_.unit(place.module);
  const Expression& e = unit.expressions[id];
  switch (e.kind) {
    case ExpressionKind::name: {
      if (e.use == kNone) return false;
      const Target& found = target(place.module, e.use);
      if (found.kind == TargetKind::word) return selector_of_word(unit.name(e.name)).has_value();
      return found.kind == TargetKind::function && built_ins()[found.index].name == "isTagged";
    }
    case ExpressionKind::unary:
      return mentions_selector(e.first, place);
    case ExpressionKind::binary:
      return mentions_selector(e.first, place) || mentions_selector(e.second, place);
    case ExpressionKind::number:
    case ExpressionKind::text:
    case ExpressionKind::truth:
    case ExpressionKind::index:
    case ExpressionKind::array:
    case ExpressionKind::range:
    case ExpressionKind::cases:
    case ExpressionKind::chances:
    case ExpressionKind::component_map:
      break;
  }
  return false;
}

std::vector<std::size_t> Run::choose_components(NodeId id, const ComponentSplit& split, std::vector<bool>& taken,
                                                std::string& text, Place& place) {
  const Unit& unit = program_.unit(place.module);
  const Expression& e = unit.expressions[id];
  std::optional<Selector> selector;
  bool each = false;
  const Target* found = e.kind == ExpressionKind::name && e.use != kNone ? &target(place.module, e.use) : nullptr;
  if (found != nullptr && found->kind == TargetKind::word) {
    text = unit.name(e.name);
    if (without_selector(text)) return {};
    selector = selector_of_word(text);
    if (!selector) tell(Severity::error, "selector", e.location, "this word selects nothing", text);
  } else if (found != nullptr && found->kind == TargetKind::function && built_ins()[found->index].name == "isTagged") {
    if (without(found->index)) return {};
    const auto given = arguments(e.arguments, place);
    const std::string query = given.empty() ? std::string() : this->text(given[0].value, place);
    selector = selector_of_tag(query, given.size() > 1 ? this->text(given[1].value, place) : std::string());
    text = "isTagged(\"" + query + "\")";
  } else if (mentions_selector(id, place)) {
    each = true;
    text = "expression";
  } else {
    const Value value = evaluate(id, place);
    text = value_text(value);
    if (const auto* index = std::get_if<double>(&value))
      selector = selector_of_index(*index);
    else if (type_of(value) == Type::truth)
      each = true;
    else
      selector = selector_of_word(text);
    if (!selector && !each) tell(Severity::error, "selector", e.location, "this selects nothing", text);
  }
  std::vector<std::size_t> chosen;
  if (!selector && !each) return chosen;
  for (std::size_t i = 0; i < split.items.size(); ++i) {
    if (taken[i]) continue;
    bool take = false;
    if (selector) {
      take = selector->kind == Selector::Kind::all || selected(split, i, *selector);
    } else {
      // An expression on each of many faces is as much work as a function called as often.
      if (++calls_ > options_.limits.calls) {
        tell_too_many_calls(e.location, text);
        break;
      }
      Shape shape = component_shape(split, i);
      const ComponentTest test{&split, i};
      Place there = place;
      there.shape = &shape;
      there.component = &test;
      take = condition(id, there);
    }
    if (!take) continue;
    taken[i] = true;
    chosen.push_back(i);
  }
  return chosen;
}

void Run::run_selectors(const Block& block, const ComponentSplit& split, Work& work, Place& place) {
  std::vector<bool> taken(split.items.size(), false);
  work.produced = true;
  const auto items = block.items;
  for (std::uint32_t k = 0; k < items.count; ++k) {
    const BlockItem& item = program_.unit(place.module).items[items.first + k];
    std::string text;
    const auto chosen = choose_components(item.value, split, taken, text, place);
    if (chosen.empty()) continue;
    if (item.op == ItemOperator::each) {
      for (std::size_t i = 0; i < chosen.size() && !pieces_full(); ++i) {
        Shape shape = component_shape(split, chosen[i]);
        shape.component = {text, static_cast<std::int32_t>(i), static_cast<std::int32_t>(chosen.size())};
        run_item(item.successor, std::move(shape), work, place);
      }
      continue;
    }
    std::vector<std::vector<std::size_t>> sets;
    if (item.op == ItemOperator::all)
      sets.push_back(chosen);
    else
      sets = connected_sets(split, chosen);
    for (std::size_t i = 0; i < sets.size(); ++i) {
      auto shape = component_group(split, sets[i]);
      if (!shape) continue;
      shape->component = {text, static_cast<std::int32_t>(i), static_cast<std::int32_t>(sets.size())};
      run_item(item.successor, std::move(*shape), work, place);
    }
  }
}

void Run::step_components(const Call& call, Work& work, Place& place) {
  if (call.block == kNone) return tell(Severity::error, "arguments", call.location, "comp needs a block", "comp");
  evaluate_operation_arguments(call, place);
  const auto kind = operands_.empty() ? std::nullopt : component_kind(operands_[0].word);
  if (!kind) return tell(Severity::error, "arguments", call.location, "comp takes f, e, fe, v, fv, g, m or h", "comp");
  work.produced = true;
  if (pieces_full()) return;
  const bool keep = operands_.size() > 1 && operands_[1].word == "noAlign";
  keep_occluder(work.shape, work.lineage);
  const ComponentSplit split =
      components(work.shape, *kind, keep ? ComponentAlignment::none : ComponentAlignment::z_up);
  run_selectors(program_.unit(place.module).blocks[call.block], split, work, place);
}

std::vector<int> Run::edges_by_item(const Block& block, const ComponentSplit& edges, Place& place) {
  std::vector<int> out(edges.items.size(), -1);
  std::vector<bool> taken(edges.items.size(), false);
  for (std::uint32_t k = 0; k < block.items.count; ++k) {
    const BlockItem& item = program_.unit(place.module).items[block.items.first + k];
    if (selector_text(item.value, place) == "remainder") continue;
    std::string text;
    for (const std::size_t edge : choose_components(item.value, edges, taken, text, place))
      out[edge] = static_cast<int>(k);
  }
  return out;
}

std::string Run::selector_text(NodeId id, const Place& place) const {
  const Unit& unit = program_.unit(place.module);
  const Expression& e = unit.expressions[id];
  return e.kind == ExpressionKind::name && !without_selector(unit.name(e.name)) ? unit.name(e.name) : std::string();
}

void Run::run_strips(const Call& call, const std::vector<int>& chosen_by, const std::vector<double>& distances,
                     Work& work, Place& place) {
  const Block& block = program_.unit(place.module).blocks[call.block];
  SetbackPieces pieces = setback_pieces(work.shape, distances);
  work.produced = true;
  for (std::uint32_t k = 0; k < block.items.count; ++k) {
    const BlockItem& item = program_.unit(place.module).items[block.items.first + k];
    const std::string text = selector_text(item.value, place);
    if (text == "remainder") {
      if (!pieces.remainder) continue;
      pieces.remainder->component = {text, 0, 1};
      run_item(item.successor, *pieces.remainder, work, place);
      continue;
    }
    std::vector<Shape> strips;
    for (std::size_t i = 0; i < pieces.pieces.size() && i < chosen_by.size(); ++i)
      if (chosen_by[i] == static_cast<int>(k) && pieces.pieces[i]) strips.push_back(std::move(*pieces.pieces[i]));
    if (strips.empty()) continue;
    if (item.op != ItemOperator::each) {
      auto merged = merge_pieces(strips);
      if (!merged) continue;
      strips.assign(1, std::move(*merged));
    }
    for (std::size_t i = 0; i < strips.size(); ++i) {
      strips[i].component = {text, static_cast<std::int32_t>(i), static_cast<std::int32_t>(strips.size())};
      run_item(item.successor, std::move(strips[i]), work, place);
    }
  }
}

void Run::step_setback(const Call& call, Work& work, Place& place) {
  if (call.block == kNone || call.arguments.count == 0)
    return tell(Severity::error, "arguments", call.location, "setback needs a distance and a block", "setback");
  evaluate_operation_arguments(call, place);
  const ComponentSplit edges = setback_edges(work.shape);
  std::vector<double> distances(edges.items.size(), 0);
  const Value distance = operands_[0].value;
  const std::vector<int> chosen_by = edges_by_item(program_.unit(place.module).blocks[call.block], edges, place);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (chosen_by[i] < 0) continue;
    if (const auto* one = std::get_if<double>(&distance)) distances[i] = *one;
    if (const auto* many = std::get_if<NumberArray>(&distance))
      distances[i] = i < many->items.size() ? many->items[i] : 0;
  }
  run_strips(call, chosen_by, distances, work, place);
}

void Run::step_setback_per_edge(const Call& call, Work& work, Place& place) {
  if (call.block == kNone || call.arguments.count == 0)
    return tell(Severity::error, "arguments", call.location, "setbackPerEdge needs a distance and a block",
                "setbackPerEdge");
  const ComponentSplit edges = setback_edges(work.shape);
  std::vector<double> distances(edges.items.size(), 0);
  const std::vector<int> chosen_by = edges_by_item(program_.unit(place.module).blocks[call.block], edges, place);
  const NodeId distance = arguments(call.arguments, place)[0].value;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (chosen_by[i] < 0) continue;
    Shape edge = component_shape(edges, i);
    edge.component = {"all", static_cast<std::int32_t>(i), static_cast<std::int32_t>(distances.size())};
    edge.seed = child_seed(work);
    edge.draws = 0;
    Place there = place;
    there.shape = &edge;
    distances[i] = number(distance, there);
  }
  run_strips(call, chosen_by, distances, work, place);
}

void Run::step_setback_to_area(const Call& call, Work& work, Place& place) {
  if (call.block == kNone || call.arguments.count == 0)
    return tell(Severity::error, "arguments", call.location, "setbackToArea needs an area and a block",
                "setbackToArea");
  evaluate_operation_arguments(call, place);
  const auto* area = std::get_if<double>(&operands_[0].value);
  std::vector<double> minimum, maximum;
  if (operands_.size() > 1)
    if (const auto* many = std::get_if<NumberArray>(&operands_[1].value)) minimum = many->items;
  if (operands_.size() > 2)
    if (const auto* many = std::get_if<NumberArray>(&operands_[2].value)) maximum = many->items;
  if (area == nullptr)
    return tell(Severity::error, "arguments", call.location, "the area is a number", "setbackToArea");
  const double wanted = *area;
  const ComponentSplit edges = setback_edges(work.shape);
  const std::vector<int> chosen_by = edges_by_item(program_.unit(place.module).blocks[call.block], edges, place);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < chosen_by.size(); ++i)
    if (chosen_by[i] >= 0) chosen.push_back(i);
  run_strips(call, chosen_by, setback_to_area(work.shape, chosen, wanted, minimum, maximum), work, place);
}

void Run::run_shape_and_remainder(const Call& call, const ShapeAndRemainder& pieces, Work& work, Place& place) {
  const Block& block = program_.unit(place.module).blocks[call.block];
  work.produced = true;
  bool taken[2] = {false, false};
  for (std::uint32_t k = 0; k < block.items.count; ++k) {
    const BlockItem& item = program_.unit(place.module).items[block.items.first + k];
    const std::string text = selector_text(item.value, place);
    std::vector<Shape> shapes;
    if ((text == "shape" || text == "all") && !taken[0]) shapes = pieces.shapes, taken[0] = true;
    if ((text == "remainder" || text == "all") && !taken[1]) {
      shapes.insert(shapes.end(), pieces.remainders.begin(), pieces.remainders.end());
      taken[1] = true;
    }
    if (shapes.empty()) continue;
    if (item.op != ItemOperator::each) {
      auto merged = merge_pieces(shapes);
      if (!merged) continue;
      shapes.assign(1, std::move(*merged));
    }
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      shapes[i].component = {text, static_cast<std::int32_t>(i), static_cast<std::int32_t>(shapes.size())};
      run_item(item.successor, std::move(shapes[i]), work, place);
    }
  }
}

void Run::step_shape_luo(const Call& call, Work& work, Place& place) {
  const std::string& name = program_.unit(place.module).name(call.name);
  evaluate_operation_arguments(call, place);
  std::vector<double> widths;
  for (const Argument& operand : operands_) {
    const auto* width = std::get_if<double>(&operand.value);
    widths.push_back(width != nullptr ? *width : 0);
  }
  const std::size_t needed = name == "shapeL" ? 2 : name == "shapeU" ? 3 : 4;
  if (call.block == kNone || widths.size() != needed)
    return tell(Severity::error, "arguments", call.location, "needs " + std::to_string(needed) + " widths and a block",
                name);
  if (needed == 2)
    widths = {widths[0], 0, 0, widths[1]};
  else if (needed == 3)
    widths = {widths[0], widths[1], 0, widths[2]};
  run_shape_and_remainder(call, shape_lu_o_pieces(work.shape, widths[0], widths[1], widths[2], widths[3]), work, place);
}

void Run::step_inner_rectangle(const Call& call, Work& work, Place& place) {
  evaluate_operation_arguments(call, place);
  if (call.block == kNone || operands_.size() != 1 || operands_[0].word.empty())
    return tell(Severity::error, "arguments", call.location, "needs scope or edge, and a block", "innerRectangle");
  run_shape_and_remainder(call, inner_rectangle_pieces(work.shape, operands_[0].word == "edge"), work, place);
}

void Run::step_scatter(const Call& call, Work& work, Place& place) {
  evaluate_operation_arguments(call, place);
  const Block* block = call.block == kNone ? nullptr : &program_.unit(place.module).blocks[call.block];
  if (block == nullptr || block->items.empty() || operands_.size() < 3)
    return tell(Severity::error, "arguments", call.location, "needs where, how many, uniform or gaussian, and a block",
                "scatter");
  const std::string& where = operands_[0].word;
  const auto domain = where == "volume"  ? ScatterDomain::volume
                      : where == "scope" ? ScatterDomain::scope
                                         : ScatterDomain::surface;
  const auto* count = std::get_if<double>(&operands_[1].value);
  const bool gaussian = operands_[2].word == "gaussian";
  std::string mean = "center";
  // Default deviation: 0.16 of the scope (docs/rule_language.md §2.5).
  constexpr double kDefaultDeviation = 0.16;
  const Vector3 size = work.shape.size;
  Vector3 deviation{size.x * kDefaultDeviation, size.y * kDefaultDeviation, size.z * kDefaultDeviation};
  for (std::size_t i = 3; i < operands_.size(); ++i) {
    if (!operands_[i].word.empty())
      mean = operands_[i].word;
    else if (const auto* given = std::get_if<double>(&operands_[i].value))
      deviation = operands_[i].mark == Mark::relative ? Vector3{size.x * *given, size.y * *given, size.z * *given}
                                                      : Vector3{*given, *given, *given};
  }
  constexpr double kMost = 100000;
  const int wanted = count == nullptr ? 0 : static_cast<int>(std::clamp(*count, 0.0, kMost));
  work.produced = true;
  const NodeId successor = program_.unit(place.module).items[block->items.first].successor;
  for (Shape& point : scatter(work.shape, domain, wanted,
                              gaussian ? ScatterDistribution::gaussian : ScatterDistribution::uniform, mean, deviation))
    run_item(successor, std::move(point), work, place);
}

}  // namespace blockrand::grammar
