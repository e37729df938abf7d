// What leaves of a derivation on a wall become: elements, bodies of rules, paint.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/facades/facade_builder.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::facades {

using model::BuildingPart;
using model::IssueCode;
using model::Point2;

/// m between a mapped entrance and the door that stands for it: rules put doors on the nearest axis, and axes are up to
/// 3.4 m apart.
static constexpr double kDoorOfEntrance = 1.7;

void FacadeBuilder::take(const FacadeContext& context, const grammar::Leaf& leaf) {
  const grammar::ElementRequest& order = *leaf.order;
  if (order.name == kPaintOperation) return note_paint(context, leaf);
  if (order.arguments.empty() || !std::holds_alternative<std::string>(order.arguments[0])) {
    tell("blockrand." + order.name + " wants the name of an element first");
    return;
  }
  const grammar::Frame frame = grammar::scope_in_object(leaf.shape);
  const double left = frame.origin.x, low = frame.origin.y, width = leaf.shape.size.x, height = leaf.shape.size.y;
  if (!(ElementLibrary::size(width) > 0 && ElementLibrary::size(height) > 0)) return;
  const elements::ElementKind* kind = grammars_.elements().find(std::get<std::string>(order.arguments[0]));
  const bool run = kind && kind->width.measures == "run";
  std::vector<std::pair<double, double>>& pieces = pieces_;
  pieces.assign({{left, left + width}});
  for (const PassagePortal& m : portals_) {
    if (m.wall != context.segment.wall || low >= m.high + kBesidePortal || low + height <= m.low) continue;
    const double from = m.left - kBesidePortal, to = m.right + kBesidePortal;
    if (left >= to || left + width <= from) continue;
    if (!run) {
      ++yielding_;
      if (kind && kind->semantic == model::ElementClass::door && at_entrance(context, left, left + width))
        ++missed_doors_;
      return;
    }
    // Pieces are in order from left to right, and so are what a portal leaves of one.
    for (std::size_t i = 0; i < pieces.size();) {
      const auto [a, b] = pieces[i];
      if (a >= to || b <= from) {
        ++i;
        continue;
      }
      const auto at = pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
      std::size_t kept = 0;
      if (b - to >= kind->width.least) pieces.insert(at, {to, b}), ++kept;
      if (from - a >= kind->width.least)
        pieces.insert(pieces.begin() + static_cast<std::ptrdiff_t>(i), {a, from}), ++kept;
      i += kept;
    }
  }
  if (run) pieces = no_longer_than(kind->width.most, pieces);
  const std::int32_t storey = storey_at(context, low);
  for (const auto& [from, to] : pieces) {
    const auto [made_width, made_height] = ElementLibrary::size(kind, to - from, height);
    PartMaterials looks = usual_materials_;
    if (const auto painted = painted_.find(context.wall.face); painted != painted_.end())
      looks[static_cast<std::size_t>(model::ElementPart::wall)] = painted->second;
    library_.ask(std::get<std::string>(order.arguments[0]), made_width, made_height, looks);
    complaints_.clear();
    library_.add_request(order, from == left, to == left + width, complaints_);
    for (const std::string& what : complaints_) tell(what);
    place(context.segment.wall, {(from + to) / 2, low}, storey);
  }
}

void FacadeBuilder::place(std::uint32_t wall, Point2 at, std::int32_t storey) {
  std::string error;
  const std::uint32_t element = library_.take(error);
  if (!error.empty()) tell(error);
  if (element != ElementLibrary::kNone) asked_.push_back({wall, element, at, storey});
}

std::vector<std::pair<double, double>> FacadeBuilder::no_longer_than(double most,
                                                                     std::span<const std::pair<double, double>> runs) {
  std::vector<std::pair<double, double>> out;
  for (const auto& [from, to] : runs) {
    const int count = std::max(1, static_cast<int>(std::ceil((to - from) / most)));
    for (int i = 0; i < count; ++i)
      out.emplace_back(i == 0 ? from : from + (to - from) * i / count,
                       i + 1 == count ? to : from + (to - from) * (i + 1) / count);
  }
  return out;
}

bool FacadeBuilder::at_entrance(const FacadeContext& context, double left, double right) {
  const std::vector<double> places = entrance_places(context);
  return std::any_of(places.begin(), places.end(), [&](double from_segment) {
    const double u = context.segment.from + from_segment;
    return u >= left - kDoorOfEntrance && u <= right + kDoorOfEntrance;
  });
}

std::int32_t FacadeBuilder::storey_at(const FacadeContext& context, double low) {
  const double storey_height = context.part.attributes.storey_height.value;
  const double above = low + context.wall.base - context.part.attributes.ground_height.value -
                       context.part.attributes.plinth_height.value;
  return storey_height > 0 ? std::max(0, static_cast<std::int32_t>(std::floor(above / storey_height + 0.25))) : 0;
}

RuleGeometry FacadeBuilder::geometry_of(const FacadeContext& context, std::span<const grammar::Leaf> leaves) {
  const model::PartMaterial& usual = usual_materials_[static_cast<std::size_t>(model::ElementPart::wall)];
  std::vector<KeptFree> portals;
  for (const PassagePortal& m : portals_)
    if (m.wall == context.segment.wall)
      portals.push_back({m.left - kBesidePortal, m.right + kBesidePortal, m.high + kBesidePortal});
  const auto painted = painted_.find(context.wall.face);
  RuleGeometry made = rule_geometry(leaves, context.wall, portals, usual,
                                    painted == painted_.end() ? nullptr : &painted->second, defaults_);
  painted_.emplace(context.wall.face, made.ground);
  return made;
}

void FacadeBuilder::take_geometry(const FacadeContext& context, RuleGeometry made) {
  yielding_geometry_ += made.yielding;
  for (const auto& [what, count] : made.dropped) dropped_[what] += count;
  for (const std::string& texture : made.textures)
    tell("the image " + texture + " is not shown: what rules make has colours alone");
  for (RuleBody& body : made.bodies) {
    double low = 1e300;
    for (const model::Point3& v : body.element.mesh.vertices) low = std::min(low, v.y + body.at.y);
    const std::int32_t storey = storey_at(context, low);
    const Point2 at = body.at;
    asked_.push_back({context.segment.wall, library_.add_made(std::move(body.element), body.materials), at, storey});
  }
}

void FacadeBuilder::note_paint(const FacadeContext& context, const grammar::Leaf& leaf) {
  std::string colour, material, storey;
  const auto& arguments = leaf.order->arguments;
  for (std::size_t i = 1; i + 1 < arguments.size(); i += 2) {
    const auto *name = std::get_if<std::string>(&arguments[i]), *value = std::get_if<std::string>(&arguments[i + 1]);
    if (name && value) (*name == "colour" ? colour : material) = *value;
    if (const auto* number = std::get_if<double>(&arguments[i + 1])) storey = fmt::format("storey {:g}", *number);
  }
  if (colour.empty() && material.empty()) return;
  const grammar::Frame frame = grammar::scope_in_object(leaf.shape);
  add_paint(context, frame.origin.x, frame.origin.x + leaf.shape.size.x, frame.origin.y,
            frame.origin.y + leaf.shape.size.y, colour, material, std::move(storey));
}

void FacadeBuilder::paint_edge(const FacadeContext& context) {
  if (context.building.detail_overrides.empty()) return;
  const std::string colour = edge_order(context, "colour"), material = edge_order(context, "material");
  if (!colour.empty() || !material.empty())
    add_paint(context, context.segment.from, context.segment.to, 0, context.wall.height, colour, material, "edge");
}

void FacadeBuilder::add_paint(const FacadeContext& context, double left, double right, double low, double high,
                              const std::string& colour, const std::string& material, std::string name) {
  PaintOrder order{context.segment.wall, left, right, low, high, {}, std::move(name)};
  order.look = usual_materials_[static_cast<std::size_t>(model::ElementPart::wall)];
  if (const auto ordered = model::colour_of_hex(colour))
    order.look.colour = *ordered;
  else if (!colour.empty())
    tell(colour + " is no colour: #rrggbb");
  if (const int index = defaults_.material(material); index >= 0) {
    order.look.material = static_cast<std::uint8_t>(index);
    // A material alone has its own colour.
    if (colour.empty()) order.look.colour = defaults_.materials[static_cast<std::size_t>(index)].colour;
  } else if (!material.empty()) {
    tell(material + " is no material class");
  }
  paint_orders_.push_back(std::move(order));
}

void FacadeBuilder::tell_unpainted(const model::Building& building, const BuildingPart& part) {
  // What is ordered of the whole building holds where it has such a storey; it is told once.
  const BuildingPart& highest = *std::ranges::max_element(
      building.parts, {}, [](const BuildingPart& other) { return other.attributes.storeys.value; });
  const double most = highest.attributes.storeys.value;
  for (const model::DetailOverride& d : building.detail_overrides) {
    const bool of_part = d.body == part.id;
    const bool of_building = d.body == building.id() && std::atof(d.name.c_str()) >= most && &highest == &part;
    if (d.kind != model::DetailKind::storey || !(of_part || of_building)) continue;
    const bool asked = std::ranges::any_of(
        d.values, [](const auto& value) { return value.first == "colour" || value.first == "material"; });
    const std::string name = "storey " + d.name;
    if (asked && std::ranges::none_of(paint_orders_, [&](const PaintOrder& o) { return o.name == name; }))
      report_.add(part.osm, IssueCode::parameter_unread,
                  fmt::format("{}: {} has no {}, or no wall that may be painted", d.from, part.id, name));
  }
}

}  // namespace blockrand::facades
