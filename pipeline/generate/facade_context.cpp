#include "pipeline/generate/facade_context.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/generate/wall_corners.h"

namespace blockrand::generate {
namespace {

using grammar::Value;
using C = FacadeContext;

const model::FacadeEdge* edge_of(const C& c) {
  const model::FacadeEdge* best = nullptr;
  for (const std::uint32_t i : c.stretch.edges)
    if (!best || c.building.edges[i].length() > best->length()) best = &c.building.edges[i];
  return best;
}

Value text(std::string_view t) { return std::string(t); }
Value colour(model::Colour c) { return model::text(c); }

Value kind_text(const std::optional<model::EdgeKind>& kind) { return text(kind ? model::name(*kind) : ""); }

template <class Visit>
bool any_edge(const C& c, Visit&& visit) {
  return std::any_of(c.stretch.edges.begin(), c.stretch.edges.end(),
                     [&](std::uint32_t i) { return visit(c.building.edges[i]); });
}

/// Entrances along the stretch, m from its left end, in order.
std::vector<double> entrances(const C& c) {
  std::vector<double> out;
  for (const std::uint32_t i : c.stretch.edges)
    for (const model::EdgePoint& p : c.building.edges[i].points) {
      if (!p.entrance) continue;
      const double u = (p.place.x - c.wall.start.x) * c.wall.along.x + (p.place.y - c.wall.start.y) * c.wall.along.y -
                       c.stretch.from;
      if (u >= 0 && u <= c.stretch.length()) out.push_back(std::floor(u * 64 + 0.5) / 64);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

bool is_main_front(const C& c) {
  const auto& fronts = c.building.situation.fronts;
  return any_edge(c, [&](const model::FacadeEdge& e) {
    const auto number = static_cast<std::uint32_t>(&e - c.building.edges.data());
    return !fronts.empty() && fronts.front() == number;
  });
}

int mapped_entrances(const model::Building& b) {
  int n = 0;
  for (const model::FacadeEdge& e : b.edges) n += e.entrances;
  return n;
}

/// m above the wall's base of the eaves of its part, at most the wall's own height.
double eaves(const C& c) {
  return std::clamp(eaves_level(c.part) - c.wall.base, 0.0, c.wall.height);
}

const std::vector<ContextAttribute> kAttributes = {
    {"building.class", "", "class of appearance: gruenderzeit, tenement, modern, other",
     [](const C& c) -> Value { return c.building.attributes.style.value; }},
    {"building.depth", "m", "across the main front; 0: not known",
     [](const C& c) -> Value { return c.building.situation.depth.value_or(0); }},
    {"building.entrances", "", "entrances that are mapped anywhere on the building",
     [](const C& c) -> Value { return static_cast<double>(mapped_entrances(c.building)); }},
    {"building.era", "", "pre1840, 1840_1918, 1919_1945, post1945",
     [](const C& c) -> Value { return c.building.attributes.era.value; }},
    {"building.ground_floor_use", "", "shop, gastronomy, office … or the building's use",
     [](const C& c) -> Value { return c.building.attributes.ground_floor_use.value; }},
    {"building.height", "m", "ground to the top of the roof, of this part",
     [](const C& c) -> Value { return c.part.attributes.height.value; }},
    {"building.min_height", "m", "ground to the underside of this part",
     [](const C& c) -> Value { return c.part.attributes.min_height.value; }},
    {"building.plinth", "m", "ground to the level of the ground floor",
     [](const C& c) -> Value { return c.part.attributes.plinth_height.value; }},
    {"building.position", "", "free_standing, end_of_row, mid_row, corner_house, rear_building, side_wing, unknown",
     [](const C& c) -> Value { return text(model::name(c.building.situation.position)); }},
    {"building.preset", "", "name of the preset",
     [](const C& c) -> Value { return c.building.attributes.preset.value; }},
    {"building.roof_colour", "", "#rrggbb",
     [](const C& c) -> Value { return colour(c.part.attributes.roof_colour.value); }},
    {"building.storey_height", "m", "mean, floor to floor",
     [](const C& c) -> Value { return c.part.attributes.storey_height.value; }},
    {"building.storeys", "", "full storeys above ground",
     [](const C& c) -> Value { return c.part.attributes.storeys.value; }},
    {"building.substyle", "", "id in configs/styles/catalogue.toml",
     [](const C& c) -> Value { return c.building.attributes.substyle.value; }},
    {"building.use", "", "apartments, house, office …",
     [](const C& c) -> Value { return c.part.attributes.use.value; }},
    {"building.wall_colour", "", "#rrggbb",
     [](const C& c) -> Value { return colour(c.part.attributes.wall_colour.value); }},
    {"building.wall_material", "", "plaster, brick, stone …",
     [](const C& c) -> Value { return c.part.attributes.wall_material.value; }},
    {"building.width", "m", "along the main front; 0: not known",
     [](const C& c) -> Value { return c.building.situation.width.value_or(0); }},
    {"edge.chamfer", "", "cuts off a street corner",
     [](const C& c) -> Value { return any_edge(c, [](const model::FacadeEdge& e) { return e.chamfer; }); }},
    {"edge.corner_left", "", "the left end is a corner of the building",
     [](const C& c) -> Value { return c.stretch.starts_wall; }},
    {"edge.corner_right", "", "the right end is a corner of the building",
     [](const C& c) -> Value { return c.stretch.ends_wall; }},
    {"edge.eaves", "m", "the wall's base to the eaves", [](const C& c) -> Value { return eaves(c); }},
    {"edge.entrance", "m", "left end to the first mapped entrance; -1: none",
     [](const C& c) -> Value {
       const auto at = entrances(c);
       return at.empty() ? -1.0 : at.front();
     }},
    {"edge.entrances", "", "mapped entrances of this stretch",
     [](const C& c) -> Value { return static_cast<double>(entrances(c).size()); }},
    {"edge.kind", "", "street, courtyard, side, passage",
     [](const C& c) -> Value { return text(model::name(c.stretch.kind)); }},
    {"edge.kind_left", "",
     "kind of the stretch beyond the left end, round the corner too; empty: none with the same base and eaves",
     [](const C& c) -> Value { return kind_text(c.stretch.kind_left); }},
    {"edge.kind_right", "", "the same of the right end",
     [](const C& c) -> Value { return kind_text(c.stretch.kind_right); }},
    {"edge.length", "m", "of the stretch", [](const C& c) -> Value { return c.stretch.length(); }},
    {"edge.main_front", "", "the longest stretch of the main front",
     [](const C& c) -> Value { return is_main_front(c); }},
    {"edge.raised", "m", "the ground to the base of the wall: more than 0 above passages and lower parts",
     [](const C& c) -> Value { return std::max(0.0, c.wall.base - c.part.attributes.ground_height.value); }},
    {"edge.street_class", "", "of the street it faces: primary, residential …; empty: none",
     [](const C& c) -> Value {
       const auto* e = edge_of(c);
       return e ? e->street_class : std::string();
     }},
    {"edge.street_distance", "m", "its middle to the street's line; 0: none",
     [](const C& c) -> Value {
       const auto* e = edge_of(c);
       return e && e->street.number != 0 ? static_cast<double>(e->street_distance) : 0.0;
     }},
    {"edge.street_name", "", "of the street it faces",
     [](const C& c) -> Value {
       const auto* e = edge_of(c);
       return e ? e->street_name : std::string();
     }},
    {"edge.turn_left", "degrees",
     "turn of the walls at the left end, positive at corners that stand out; 0: the wall goes on, or edge.kind_left is empty",
     [](const C& c) -> Value { return c.stretch.turn_left; }},
    {"edge.turn_right", "degrees", "the same of the right end",
     [](const C& c) -> Value { return c.stretch.turn_right; }},
    {"roof.height", "m", "eaves to the top", [](const C& c) -> Value { return c.part.attributes.roof_height.value; }},
    {"roof.pitch", "degrees", "of the main slope",
     [](const C& c) -> Value { return c.part.attributes.roof_pitch.value; }},
    {"roof.shape", "", "as it was built: flat, gabled, hipped …",
     [](const C& c) -> Value { return text(model::name(c.part.built_roof)); }},
};

}  // namespace

const std::vector<ContextAttribute>& context_attributes() { return kAttributes; }

std::optional<Value> context_value(const FacadeContext& context, std::string_view name) {
  const auto place = std::lower_bound(kAttributes.begin(), kAttributes.end(), name,
                                      [](const ContextAttribute& a, std::string_view n) { return a.name < n; });
  if (place == kAttributes.end() || place->name != name) return std::nullopt;
  return place->read(context);
}

}  // namespace blockrand::generate
