// Functions that ask about the current shape, its components, its surroundings and its place in the tree
// (docs/rule_language.md §3.2).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "styles/grammar/evaluation/arrays.h"
#include "styles/grammar/evaluation/run.h"
#include "styles/grammar/language/value_text.h"
#include "styles/grammar/shapes/measure.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::grammar {
namespace {

/// `isPlanar` and `isRectangular` without a tolerance, in degrees.
constexpr double kPlaneTolerance = 1, kRightAngleTolerance = 1;

Value text_array(std::vector<std::string> items) {
  const std::size_t count = items.size();
  return TextArray{std::move(items), count};
}

std::optional<CoordinateSystem> system_of(std::string_view word) {
  if (word == "scope") return CoordinateSystem::scope;
  if (word == "pivot") return CoordinateSystem::pivot;
  if (word == "object") return CoordinateSystem::object;
  if (word == "world") return CoordinateSystem::world;
  return std::nullopt;
}

}  // namespace

Value Run::geometry_number(const Expression& e, Place& place) {
  const std::string_view name = built_ins()[target(place.module, e.use).index].name.substr(9);
  const Shape& shape = *place.shape;
  const auto given = arguments(e.arguments, place);
  if (name == "area") {
    if (given.empty()) return geometry_area(shape);
    const std::string selector =
        word(given[0], place).empty() ? text(given[0].value, place) : std::string(word(given[0], place));
    if (const auto area = geometry_area(shape, selector)) return *area;
    tell(Severity::error, "value", e.location, "this word selects no faces; 0 is taken", selector);
    return 0.0;
  }
  if (name == "angle") {
    const std::string which = given.empty() ? std::string() : text(given[0].value, place);
    if (const auto angle = geometry_angle(shape, which)) return *angle;
    tell(Severity::error, "value", e.location, "geometry.angle takes maxSlope, azimuth or zenith; 0 is taken", which);
    return 0.0;
  }
  if (name == "volume") return geometry_volume(shape);
  if (name == "height") return geometry_height(shape);
  if (name == "boundaryLength") return geometry_boundary_length(shape);
  if (name == "nFaces") return static_cast<double>(geometry_face_count(shape));
  if (name == "nEdges") return static_cast<double>(geometry_edge_count(shape));
  if (name == "nVertices") return static_cast<double>(geometry_vertex_count(shape));
  return static_cast<double>(geometry_hole_count(shape));
}

Value Run::geometry_truth(const Expression& e, Place& place) {
  const std::string_view name = built_ins()[target(place.module, e.use).index].name.substr(9);
  const Shape& shape = *place.shape;
  const auto given = arguments(e.arguments, place);
  if (name == "isConcave") return geometry_is_concave(shape);
  if (name == "isClosedSurface") return geometry_is_closed(shape);
  if (name == "isPlanar")
    return geometry_is_planar(shape, given.empty() ? kPlaneTolerance : number(given[0].value, place));
  if (name == "isRectangular")
    return geometry_is_rectangular(shape, given.empty() ? kRightAngleTolerance : number(given[0].value, place));
  if (name == "hasUVs")
    return geometry_has_uvs(shape, given.empty() ? 0 : static_cast<int>(number(given[0].value, place)));
  if (name == "hasTags")
    return given.empty() ? !geometry_tags(shape).empty() : geometry_is_tagged(shape, text(given[0].value, place));
  if (name == "isOriented") {
    const std::string selector = given.empty() ? std::string() : text(given[0].value, place);
    if (const auto oriented = geometry_is_oriented(shape, selector)) return *oriented;
    tell(Severity::error, "value", e.location, "this word selects no faces; false is taken", selector);
  }
  return false;  // isInstanced: nothing is an instance here
}

Value Run::geometry_words(const Expression& e, Place& place) {
  const std::string_view name = built_ins()[target(place.module, e.use).index].name.substr(9);
  const auto given = arguments(e.arguments, place);
  if (name == "tags")
    return text_array(geometry_tags(*place.shape, given.empty() ? std::string() : text(given[0].value, place)));
  if (name == "materials") return text_array(geometry_materials(*place.shape));
  return TextArray{};
}

Value Run::geometry_uv(const Expression& e, Place& place) {
  const std::string_view name = built_ins()[target(place.module, e.use).index].name.substr(9);
  int set = 0;
  bool unit_space = false;
  for (const ArgumentNode& argument : arguments(e.arguments, place)) {
    const std::string_view bare = word(argument, place);
    if (bare.empty())
      set = static_cast<int>(number(argument.value, place));
    else
      unit_space = bare == "unitSpace";
  }
  if (set < 0 || set >= kUvSetCount) {
    tell(Severity::error, "value", e.location, "there is no such set of coordinates; 0 is taken", std::to_string(set));
    return 0.0;
  }
  if (name == "du" || name == "dv") return geometry_uv_extent(*place.shape, name == "dv", unit_space, set);
  const bool v = name[0] == 'v';
  return name.ends_with("Min") ? geometry_uv_minimum(*place.shape, v, set) : geometry_uv_maximum(*place.shape, v, set);
}

/// inside, overlaps, touches, minimumDistance, contextCount: from what the first derivation left
/// (docs/rule_language.md §4.6). Shapes do not ask about their ancestors and descendants. There are no neighbours in a
/// derivation: `inter` finds nothing.
Value Run::context_query(const Expression& e, Place& place) {
  const std::string_view name = built_ins()[target(place.module, e.use).index].name;
  std::string goal = "all", label;
  bool goal_given = false;
  for (const ArgumentNode& argument : arguments(e.arguments, place)) {
    const std::string given = text(argument.value, place);
    if (!goal_given && (given == "intra" || given == "inter" || given == "all")) {
      goal = given;
      goal_given = true;
    } else {
      label = given;
    }
  }
  if (recorded_ != nullptr && goal != "inter") recorded_->asked = true;
  if (known_ == nullptr || goal == "inter") return context_default(e, place);
  const std::vector<std::uint32_t> way = way_of(place.lineage);
  const auto related = [&](const Occluder& other) {
    const std::size_t shared = std::min(way.size(), other.lineage.size());
    return std::equal(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(shared), other.lineage.begin());
  };
  const bool by_distance = name == "minimumDistance", by_count = name == "contextCount";
  const Box box = by_distance || by_count ? Box() : box_in_world(*place.shape);
  std::optional<Mesh> mesh;  // made for the first shape that comes near
  const auto corners = scope_corners(*place.shape);
  double nearest = std::numeric_limits<double>::infinity();
  double count = 0;
  bool found = false;
  Effort effort{options_.limits.calls - std::min(calls_, options_.limits.calls)};
  for (const Occluder& other : known_->occluders) {
    if (found || !effort.take(1)) break;
    if ((!label.empty() && other.label != label) || related(other)) continue;
    if (by_count) {
      ++count;
    } else if (by_distance) {
      nearest = std::min(nearest, box_distance(corners, other.scope_corners));
    } else if (boxes_meet(box, other.box)) {
      if (!mesh) mesh = mesh_in_world(*place.shape);
      found = name == "inside"     ? is_inside(*mesh, other, effort)
              : name == "overlaps" ? overlaps(*mesh, other, effort)
                                   : touches(*mesh, other, effort);
    }
  }
  calls_ = options_.limits.calls - effort.left;
  if (effort.spent) {
    calls_ = options_.limits.calls + 1;
    tell_too_many_calls(e.location, std::string(name));
    return context_default(e, place);
  }
  return by_count ? Value(count) : by_distance ? Value(nearest) : Value(found);
}

/// As if nothing stood near (docs/rule_language.md §4.6, first pass).
Value Run::context_default(const Expression& e, Place& place) {
  const std::string_view name = built_ins()[target(place.module, e.use).index].name;
  if (name == "minimumDistance") return std::numeric_limits<double>::infinity();
  if (name == "inside" || name == "overlaps" || name == "touches") return false;
  return 0.0;
}

Value Run::convert_coordinates(const Expression& e, Place& place) {
  const auto given = arguments(e.arguments, place);
  std::vector<std::string> words;
  std::vector<double> numbers;
  for (const ArgumentNode& argument : given) {
    const Value value = evaluate(argument.value, place);
    if (const auto* one = std::get_if<double>(&value))
      numbers.push_back(*one);
    else if (const auto* many = std::get_if<NumberArray>(&value))
      numbers = many->items;
    else
      words.push_back(value_text(value));
  }
  const bool one_axis = words.size() == 4;
  const std::size_t at = one_axis ? 1 : 0;
  const auto from = words.size() > at ? system_of(words[at]) : std::nullopt;
  const auto to = words.size() > at + 1 ? system_of(words[at + 1]) : std::nullopt;
  if (words.size() < 3 || !from || !to || numbers.size() != 3 ||
      (one_axis && (words[0].size() != 1 || words[0][0] < 'x' || words[0][0] > 'z'))) {
    tell(Severity::error, "value", e.location, "convert takes (axis, from, to, pos or orient, x, y, z); 0 is taken");
    return one_axis ? Value(0.0) : Value(NumberArray{{0, 0, 0}, 3});
  }
  const Frame source = system_in_world(*place.shape, *from), goal = system_in_world(*place.shape, *to);
  const Vector3 in{numbers[0], numbers[1], numbers[2]};
  Vector3 out;
  if (words[at + 2] == "orient") {
    const Frame turned = compose(source, Frame{{}, axes_of_angles(in)});
    out = angles_of_axes(relative_to(goal, turned).axes);
  } else {
    out = grammar::place_back(goal, grammar::place(source, in));
  }
  if (!one_axis) return NumberArray{{out.x, out.y, out.z}, 3};
  return component(out, words[0][0] - 'x');
}

Value Run::edge_attribute(const Expression& e, Place& place) {
  const std::string_view kind = built_ins()[target(place.module, e.use).index].name;
  const auto given = arguments(e.arguments, place);
  const std::string name = "edgeAttr." + (given.empty() ? std::string() : text(given[0].value, place));
  auto known = source_values_.find(name);
  if (known == source_values_.end())
    known = source_values_.emplace(name, options_.source ? options_.source(name) : std::nullopt).first;
  if (kind.ends_with("Float"))
    return known->second && type_of(*known->second) == Type::number ? *known->second : Value(0.0);
  if (kind.ends_with("Bool"))
    return known->second && type_of(*known->second) == Type::truth ? *known->second : Value(false);
  return known->second ? Value(value_text(*known->second)) : Value(std::string());
}

Value Run::current_tree_key(const Expression&, Place& place) {
  return place.rule != nullptr && place.rule->node != kNone ? key_of(place.rule->node) : std::string("0;");
}

Value Run::print_value(const Expression& e, Place& place) {
  const auto given = arguments(e.arguments, place);
  if (given.empty()) return 0.0;
  Value value = evaluate(given[0].value, place);
  out_.prints.push_back(value_text(value));
  return value;
}

/// `isTagged(query)` outside of a selector: of the current shape; inside, of the component.
Value Run::tagged(const Expression& e, Place& place) {
  const auto given = arguments(e.arguments, place);
  if (given.empty()) return false;
  const std::string query = text(given[0].value, place);
  if (place.component == nullptr) return geometry_is_tagged(*place.shape, query);
  const std::string of = given.size() > 1 ? text(given[1].value, place) : std::string();
  return selected(*place.component->split, place.component->item, selector_of_tag(query, of));
}

/// `comp(kind)` without a block: one entry a component, 0 each.
Value Run::component_words(const Expression& e, Place& place) { return evaluate_component_map(e, place); }

Value Run::evaluate_component_map(const Expression& e, Place& place) {
  const Unit& unit = program_.unit(place.module);
  const auto given = arguments(e.arguments, place);
  const auto kind = given.empty() ? std::nullopt : component_kind(word(given[0], place));
  if (!kind) {
    tell(Severity::error, "value", e.location, "comp takes f, e, fe, v, fv, g, m or h");
    return NumberArray{};
  }
  if (options_.without != nullptr && options_.without->kind == NameKind::function && options_.without->name == "comp")
    return NumberArray{};
  const ComponentSplit split = components(*place.shape, *kind);
  std::vector<bool> taken(split.items.size(), false);
  std::vector<std::optional<Value>> values(split.items.size());
  std::optional<Type> type;
  std::uint32_t pieces = 0;
  const auto evaluate_on = [&](Shape shape, NodeId expression) {
    Work seeds{*place.shape, nullptr, pieces++, true, false};
    shape.seed = child_seed(seeds);
    shape.draws = 0;
    Place inner = place;
    inner.shape = &shape;
    inner.component = nullptr;
    Value value = evaluate(expression, inner);
    if (!type) type = type_of(value);
    if (type_of(value) == *type && *type < Type::number_array) return std::optional<Value>(std::move(value));
    tell(Severity::error, "type", e.location, "the entries of comp(){} must be single values of one type");
    return std::optional<Value>();
  };
  for (const ComponentValue& item : Unit::slice(unit.component_values, e.component_values)) {
    std::string text;
    const std::vector<std::size_t> chosen = choose_components(item.selector, split, taken, text, place);
    if (chosen.empty()) continue;
    std::vector<std::vector<std::size_t>> sets;
    if (item.op == ItemOperator::all)
      sets.push_back(chosen);
    else if (item.op == ItemOperator::connected)
      sets = connected_sets(split, chosen);
    else
      for (const std::size_t one : chosen) sets.push_back({one});
    for (std::size_t i = 0; i < sets.size(); ++i) {
      auto shape = item.op == ItemOperator::each ? component_shape(split, sets[i][0]) : component_group(split, sets[i]);
      if (!shape) continue;
      shape->component = {text, static_cast<std::int32_t>(i), static_cast<std::int32_t>(sets.size())};
      const auto value = evaluate_on(std::move(*shape), item.value);
      for (const std::size_t one : sets[i]) values[one] = value;
    }
  }
  Value out = default_value(array_type(type.value_or(Type::number)));
  for (std::optional<Value>& value : values) {
    const Value one = value ? std::move(*value) : default_value(type.value_or(Type::number));
    if (auto* numbers = std::get_if<NumberArray>(&out))
      numbers->items.push_back(std::get<double>(one)), ++numbers->columns;
    else if (auto* truths = std::get_if<TruthArray>(&out))
      truths->items.push_back(std::get<bool>(one)), ++truths->columns;
    else if (auto* texts = std::get_if<TextArray>(&out))
      texts->items.push_back(std::get<std::string>(one)), ++texts->columns;
  }
  return out;
}

const BuiltInActions& built_in_actions() {
  static const BuiltInActions kActions = [] {
    BuiltInActions out;
    const auto all = built_ins();
    out.functions.resize(all.size());
    out.special_functions.resize(all.size());
    out.operations.resize(all.size());
    out.special_steps.resize(all.size());
    out.attributes.resize(all.size());
    static constexpr std::pair<std::string_view, SpecialFunction> kFunctions[] = {
        {"geometry.area", &Run::geometry_number},
        {"geometry.volume", &Run::geometry_number},
        {"geometry.height", &Run::geometry_number},
        {"geometry.boundaryLength", &Run::geometry_number},
        {"geometry.nFaces", &Run::geometry_number},
        {"geometry.nEdges", &Run::geometry_number},
        {"geometry.nVertices", &Run::geometry_number},
        {"geometry.nHoles", &Run::geometry_number},
        {"geometry.angle", &Run::geometry_number},
        {"geometry.isConcave", &Run::geometry_truth},
        {"geometry.isPlanar", &Run::geometry_truth},
        {"geometry.isRectangular", &Run::geometry_truth},
        {"geometry.isClosedSurface", &Run::geometry_truth},
        {"geometry.isOriented", &Run::geometry_truth},
        {"geometry.isInstanced", &Run::geometry_truth},
        {"geometry.hasTags", &Run::geometry_truth},
        {"geometry.hasUVs", &Run::geometry_truth},
        {"geometry.groups", &Run::geometry_words},
        {"geometry.materials", &Run::geometry_words},
        {"geometry.tags", &Run::geometry_words},
        {"geometry.du", &Run::geometry_uv},
        {"geometry.dv", &Run::geometry_uv},
        {"geometry.uMin", &Run::geometry_uv},
        {"geometry.uMax", &Run::geometry_uv},
        {"geometry.vMin", &Run::geometry_uv},
        {"geometry.vMax", &Run::geometry_uv},
        {"isTagged", &Run::tagged},
        {"comp", &Run::component_words},
        {"inside", &Run::context_query},
        {"overlaps", &Run::context_query},
        {"touches", &Run::context_query},
        {"minimumDistance", &Run::context_query},
        {"contextCount", &Run::context_query},
        {"contextCompare", &Run::context_default},
        {"getGeoCoord", &Run::context_default},
        {"convert", &Run::convert_coordinates},
        {"getTreeKey", &Run::current_tree_key},
        {"edgeAttr.getFloat", &Run::edge_attribute},
        {"edgeAttr.getString", &Run::edge_attribute},
        {"edgeAttr.getBool", &Run::edge_attribute},
        {"print", &Run::print_value},
    };
    static constexpr std::pair<std::string_view, SpecialStep> kSteps[] = {
        {"NIL", &Run::step_nil},
        {"set", &Run::step_set},
        {"report", &Run::step_report},
        {"print", &Run::step_print},
        {"label", &Run::step_label},
        {"split", &Run::step_split},
        {"splitArea", &Run::step_split_area},
        {"comp", &Run::step_components},
        {"setback", &Run::step_setback},
        {"setbackPerEdge", &Run::step_setback_per_edge},
        {"setbackToArea", &Run::step_setback_to_area},
        {"shapeL", &Run::step_shape_luo},
        {"shapeU", &Run::step_shape_luo},
        {"shapeO", &Run::step_shape_luo},
        {"innerRectangle", &Run::step_inner_rectangle},
        {"scatter", &Run::step_scatter},
    };
    using Read = Value (*)(const Shape&);
    static constexpr std::pair<std::string_view, Read> kAttributes[] = {
        {"scope.sx", [](const Shape& s) { return Value(s.size.x); }},
        {"scope.sy", [](const Shape& s) { return Value(s.size.y); }},
        {"scope.sz", [](const Shape& s) { return Value(s.size.z); }},
        {"scope.tx", [](const Shape& s) { return Value(s.scope.origin.x); }},
        {"scope.ty", [](const Shape& s) { return Value(s.scope.origin.y); }},
        {"scope.tz", [](const Shape& s) { return Value(s.scope.origin.z); }},
        {"split.index", [](const Shape& s) { return Value(static_cast<double>(s.split.index)); }},
        {"split.total", [](const Shape& s) { return Value(static_cast<double>(s.split.total)); }},
        {"comp.index", [](const Shape& s) { return Value(static_cast<double>(s.component.index)); }},
        {"comp.total", [](const Shape& s) { return Value(static_cast<double>(s.component.total)); }},
        {"comp.sel", [](const Shape& s) { return Value(s.component.selector); }},
        {"trim.vertical", [](const Shape& s) { return Value(s.trim_vertical); }},
        {"trim.horizontal", [](const Shape& s) { return Value(s.trim_horizontal); }},
    };
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      const BuiltIn& entry = all[i];
      if (entry.kind == NameKind::function) {
        out.functions[i] = find_functions(entry.name);
        for (const auto& [name, run] : kFunctions)
          if (name == entry.name) out.special_functions[i] = run;
      } else if (entry.kind == NameKind::operation) {
        out.operations[i] = find_operation(entry.name);
        for (const auto& [name, run] : kSteps)
          if (name == entry.name) out.special_steps[i] = run;
        if (out.operations[i] == nullptr && out.special_steps[i] == nullptr) out.special_steps[i] = &Run::step_not_yet;
      } else if (entry.kind == NameKind::attribute) {
        for (const auto& [name, read] : kAttributes)
          if (name == entry.name) out.attributes[i] = read;
      }
    }
    return out;
  }();
  return kActions;
}

}  // namespace blockrand::grammar
