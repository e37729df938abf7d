#include "pipeline/facades/facade_context.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pipeline/facades/bodies_on_roofs.h"

namespace blockrand::facades {
namespace {

using grammar::Value;
using C = FacadeContext;

const model::WallSegment* edge_of(const C& c) {
  const model::WallSegment* best = nullptr;
  for (const std::uint32_t i : c.segment.edges)
    if (!best || c.building.edges[i].length() > best->length()) best = &c.building.edges[i];
  return best;
}

Value text(std::string_view t) { return std::string(t); }
Value colour(model::Colour c) { return model::text(c); }

Value kind_text(const std::optional<model::WallSegmentKind>& kind) { return text(kind ? model::name(*kind) : ""); }

template <class Visit>
bool any_edge(const C& c, Visit&& visit) {
  return std::any_of(c.segment.edges.begin(), c.segment.edges.end(),
                     [&](std::uint32_t i) { return visit(c.building.edges[i]); });
}

/// Uses that show a window to the street: categories of configs/styles/ground_floor.toml.
constexpr std::string_view kShopUses[] = {"shop", "gastronomy", "service", "craft"};

bool is_shop(const model::WallPoint& p) {
  return std::find(std::begin(kShopUses), std::end(kShopUses), p.use) != std::end(kShopUses);
}
bool is_entrance(const model::WallPoint& p) { return p.entrance; }

/// Points along the wall segment that are `wanted`, m from its left end, in order, each place once.
std::vector<double> places(const C& c, bool (*wanted)(const model::WallPoint&)) {
  std::vector<double> out;
  for (const std::uint32_t i : c.segment.edges)
    for (const model::WallPoint& p : c.building.edges[i].points) {
      if (!wanted(p)) continue;
      const double u = (p.place.x - c.wall.start.x) * c.wall.along.x + (p.place.y - c.wall.start.y) * c.wall.along.y -
                       c.segment.from;
      if (u >= 0 && u <= c.segment.length()) out.push_back(std::floor(u * 64 + 0.5) / 64);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Value numbers(std::vector<double> items) {
  grammar::NumberArray out;
  out.columns = items.size();
  out.items = std::move(items);
  return out;
}
Value texts(std::vector<std::string> items) {
  grammar::TextArray out;
  out.columns = items.size();
  out.items = std::move(items);
  return out;
}

/// What is ordered for one storey, edge or bay of the part, of its whole building else; empty: nothing.
std::string overridden(const C& c, model::DetailKind kind, std::string_view name, std::string_view key) {
  std::string out;
  for (const model::DetailOverride& d : c.building.detail_overrides) {
    if (d.kind != kind || d.name != name || (d.body != c.part.id && d.body != c.building.id())) continue;
    for (const auto& [known, value] : d.values)
      if (known == key && (out.empty() || d.body == c.part.id)) out = value;
  }
  return out;
}

/// What is ordered for the edges that the wall segment runs along; the first one counts.
std::string overridden_edge(const C& c, std::string_view key) {
  for (const std::uint32_t i : c.segment.edges) {
    const model::WallSegment& e = c.building.edges[i];
    if (e.from_node == 0 || e.to_node == 0) continue;
    const std::string id = "e" + std::to_string(e.from_node) + "_" + std::to_string(e.to_node);
    for (const model::DetailOverride& d : c.building.detail_overrides)
      if (d.kind == model::DetailKind::edge && (d.name == id || d.name.starts_with(id + "~")))
        for (const auto& [known, value] : d.values)
          if (known == key) return value;
  }
  return {};
}

std::size_t storey_count(const C& c) {
  // More storeys than any building has are a slip of a tag; arrays stay small.
  return static_cast<std::size_t>(std::clamp(std::ceil(c.part.attributes.storeys.value), 0.0, 200.0));
}

/// What is ordered for each storey from the ground floor up; empty texts where nothing is.
std::vector<std::string> by_storey(const C& c, std::string_view key) {
  std::vector<std::string> out(storey_count(c));
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = overridden(c, model::DetailKind::storey, std::to_string(i), key);
  return out;
}

/// The same for the bays of the main front, counted from its left end; as many as the highest number that is ordered.
std::vector<std::string> by_bay(const C& c, std::string_view key) {
  std::size_t most = 0;
  constexpr int kMostBays = 1000;
  for (const model::DetailOverride& d : c.building.detail_overrides)
    if (d.kind == model::DetailKind::bay)
      most = std::max(most, static_cast<std::size_t>(std::clamp(std::atoi(d.name.c_str()), 0, kMostBays)) + 1);
  std::vector<std::string> out(most);
  for (std::size_t i = 0; i < most; ++i) out[i] = overridden(c, model::DetailKind::bay, std::to_string(i), key);
  return out;
}

/// Gross heights by storey, m: as ordered, the rest shared out evenly. What is ordered beyond the wall's height is
/// taken in proportion.
std::vector<double> storey_heights(const C& c) {
  const auto overrides = by_storey(c, "height");
  const model::Attributes& a = c.part.attributes;
  std::vector<double> out(overrides.size(), 0);
  double sum = 0;
  std::size_t open = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = overrides[i].empty() ? 0 : std::atof(overrides[i].c_str());
    sum += out[i];
    open += overrides[i].empty() ? 1 : 0;
  }
  const double all = a.storey_height.value * static_cast<double>(out.size());
  // The others keep 1.5 m, the least that overrides may order.
  const double rest = open > 0 ? std::max(1.5, (all - sum) / static_cast<double>(open)) : 0;
  const double total = sum + rest * static_cast<double>(open);
  for (double& h : out) {
    if (h == 0) h = rest;
    if (total > 0) h *= all / total;
  }
  return out;
}

/// Index into Building::edges of the wall that people come in by: of the main front; of a house without a street front the longest
/// one on a yard, else the longest free one. kNoIndex: all are party walls.
std::uint32_t entered_by(const model::Building& building) {
  if (!building.situation.fronts.empty()) return building.situation.fronts.front();
  std::uint32_t best = model::kNoIndex;
  std::tuple<bool, bool, double> most{false, false, 0};
  for (std::uint32_t i = 0; i < building.edges.size(); ++i) {
    const model::WallSegment& e = building.edges[i];
    if (e.kind == model::WallSegmentKind::party_wall || e.kind == model::WallSegmentKind::unknown) continue;
    // Nobody enters from a light shaft, or by the wall of a passage.
    const std::tuple of{e.ring == 0 && e.kind != model::WallSegmentKind::passage,
                        e.kind == model::WallSegmentKind::courtyard, e.length()};
    if (best == model::kNoIndex || of > most) best = i, most = of;
  }
  return best;
}

bool is_main_front(const C& c) {
  const std::uint32_t front = entered_by(c.building);
  return any_edge(c, [&](const model::WallSegment& e) {
    return static_cast<std::uint32_t>(&e - c.building.edges.data()) == front;
  });
}

int mapped_entrances(const model::Building& b) {
  int n = 0;
  for (const model::WallSegment& e : b.edges) n += e.entrances;
  return n;
}

/// m above the wall's base of the eaves of its part, at most the wall's own height.
double eaves(const C& c) { return std::clamp(c.eaves - c.wall.base, 0.0, c.wall.height); }

const std::vector<ContextAttribute> kAttributes = {
    {"bay.uses", "", "ordered by bay of the main front, from its left end: door, shop, balcony …; empty: nothing",
     [](const C& c) -> Value {
       return texts(is_main_front(c) ? by_bay(c, "parameters.use") : std::vector<std::string>{});
     }},
    {"bay.windows", "", "the same: none, or a kind of window",
     [](const C& c) -> Value {
       return texts(is_main_front(c) ? by_bay(c, "parameters.window") : std::vector<std::string>{});
     }},
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
    {"building.inhabited", "", "a house of people, or an old one of shops and offices: it has hearths and an attic",
     [](const C& c) -> Value { return c.defaults && has_hearths(c.building.attributes, *c.defaults); }},
    {"building.min_height", "m", "ground to the underside of this part",
     [](const C& c) -> Value { return c.part.attributes.min_height.value; }},
    {"building.plinth", "m", "ground to the level of the ground floor",
     [](const C& c) -> Value { return c.part.attributes.plinth_height.value; }},
    {"building.position", "", "free_standing, end_of_row, mid_row, corner_house, rear_building, side_wing, unknown",
     [](const C& c) -> Value { return text(model::name(c.building.situation.position)); }},
    {"building.preset", "", "name of the preset", [](const C& c) -> Value { return c.part.attributes.preset.value; }},
    {"building.roof_colour", "", "#rrggbb",
     [](const C& c) -> Value { return colour(c.part.attributes.shown_roof_colour); }},
    {"building.storey_height", "m", "mean, floor to floor",
     [](const C& c) -> Value { return c.part.attributes.storey_height.value; }},
    {"building.storeys", "", "full storeys above ground",
     [](const C& c) -> Value { return c.part.attributes.storeys.value; }},
    {"building.substyle", "", "id in configs/styles/catalogue.toml",
     [](const C& c) -> Value { return c.building.attributes.substyle.value; }},
    {"building.use", "", "apartments, house, office …",
     [](const C& c) -> Value { return c.part.attributes.use.value; }},
    {"building.wall_colour", "", "#rrggbb",
     [](const C& c) -> Value { return colour(c.part.attributes.shown_wall_colour); }},
    {"building.wall_material", "", "plaster, brick, stone …",
     [](const C& c) -> Value { return c.part.attributes.wall_material.value; }},
    {"building.width", "m", "along the main front; 0: not known",
     [](const C& c) -> Value { return c.building.situation.width.value_or(0); }},
    {"edge.chamfer", "", "cuts off a street corner",
     [](const C& c) -> Value { return any_edge(c, [](const model::WallSegment& e) { return e.chamfer; }); }},
    {"edge.corner_left", "", "the left end is a corner of the building",
     [](const C& c) -> Value { return c.segment.starts_wall; }},
    {"edge.corner_right", "", "the right end is a corner of the building",
     [](const C& c) -> Value { return c.segment.ends_wall; }},
    {"edge.eaves", "m", "the wall's base to the eaves", [](const C& c) -> Value { return eaves(c); }},
    {"edge.entrance", "m", "left end to the first mapped entrance; -1: none",
     [](const C& c) -> Value {
       const auto at = entrance_places(c);
       return at.empty() ? -1.0 : at.front();
     }},
    {"edge.entrance_places", "m", "left end to each mapped entrance of this stretch",
     [](const C& c) -> Value { return numbers(entrance_places(c)); }},
    {"edge.entrances", "", "mapped entrances of this stretch",
     [](const C& c) -> Value { return static_cast<double>(entrance_places(c).size()); }},
    {"edge.kind", "", "street, courtyard, side, passage; as ordered, if it is",
     [](const C& c) -> Value {
       const std::string order = overridden_edge(c, "kind");
       return order.empty() ? text(model::name(c.segment.kind)) : text(order);
     }},
    {"edge.kind_left", "",
     "kind of the stretch beyond the left end, round the corner too; empty: none with the same base and eaves",
     [](const C& c) -> Value { return kind_text(c.segment.kind_left); }},
    {"edge.kind_right", "", "the same of the right end",
     [](const C& c) -> Value { return kind_text(c.segment.kind_right); }},
    {"edge.length", "m", "of the stretch", [](const C& c) -> Value { return c.segment.length(); }},
    {"edge.main_front", "",
     "the longest stretch of the main front; without a street front the longest wall on a yard, else of all",
     [](const C& c) -> Value { return is_main_front(c); }},
    {"edge.raised", "m", "the ground to the base of the wall: more than 0 above passages and lower parts",
     [](const C& c) -> Value { return std::max(0.0, c.wall.base - c.part.attributes.ground_height.value); }},
    {"edge.shops", "m", "left end to each mapped shop, restaurant, bank or workshop behind this stretch",
     [](const C& c) -> Value { return numbers(places(c, is_shop)); }},
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
     "turn of the walls at the left end, positive at corners that stand out; 0: the wall goes on, or edge.kind_left is "
     "empty",
     [](const C& c) -> Value { return c.segment.turn_left; }},
    {"edge.turn_right", "degrees", "the same of the right end",
     [](const C& c) -> Value { return c.segment.turn_right; }},
    {"roof.height", "m", "eaves to the top", [](const C& c) -> Value { return c.part.attributes.roof_height.value; }},
    {"roof.pitch", "degrees", "of the main slope",
     [](const C& c) -> Value { return c.part.attributes.roof_pitch.value; }},
    {"roof.shape", "", "as it was built: flat, gabled, hipped …",
     [](const C& c) -> Value { return text(model::name(c.part.built_roof)); }},
    {"roof.storeys", "", "attic storeys", [](const C& c) -> Value { return c.part.attributes.roof_storeys.value; }},
    {"roof.windows_below", "",
     "for rules of roofs: the kind of window of the topmost storey with windows; empty: the facades have none",
     [](const C& c) -> Value { return c.windows ? c.windows->kind : std::string(); }},
    {"roof.windows_below_colour", "", "the same: #rrggbb of their frames",
     [](const C& c) -> Value { return c.windows ? c.windows->frame_colour : std::string(); }},
    {"roof.windows_below_width", "m", "the same; 0: the facades have none",
     [](const C& c) -> Value { return c.windows ? c.windows->width : 0.0; }},
    {"storey.bases", "m", "by storey: the ground floor's level to its floor",
     [](const C& c) -> Value {
       std::vector<double> out;
       double at = 0;
       for (const double h : storey_heights(c)) {
         out.push_back(at);
         at += h;
       }
       return numbers(std::move(out));
     }},
    {"storey.colours", "", "by storey: #rrggbb as ordered; empty: nothing",
     [](const C& c) -> Value { return texts(by_storey(c, "colour")); }},
    {"storey.count", "", "full storeys above ground, as many as the lists have entries",
     [](const C& c) -> Value { return static_cast<double>(storey_count(c)); }},
    {"storey.heights", "m", "by storey: floor to floor, as ordered; the others even",
     [](const C& c) -> Value { return numbers(storey_heights(c)); }},
    {"storey.materials", "", "by storey: material class as ordered; empty: nothing",
     [](const C& c) -> Value { return texts(by_storey(c, "material")); }},
    {"storey.ordered", "", "storeys whose height is ordered",
     [](const C& c) -> Value {
       const auto overrides = by_storey(c, "height");
       return static_cast<double>(
           std::count_if(overrides.begin(), overrides.end(), [](const std::string& o) { return !o.empty(); }));
     }},
    {"storey.uses", "", "by storey: shop, office … as ordered; empty: nothing",
     [](const C& c) -> Value { return texts(by_storey(c, "use")); }},
    {"storey.windows", "", "by storey: none, or a kind of window, as ordered; empty: nothing",
     [](const C& c) -> Value { return texts(by_storey(c, "parameters.window")); }},
};

}  // namespace

std::vector<double> entrance_places(const FacadeContext& context) { return places(context, is_entrance); }

const std::vector<ContextAttribute>& context_attributes() { return kAttributes; }

std::optional<Value> context_value(const FacadeContext& context, std::string_view name) {
  const auto place = std::lower_bound(kAttributes.begin(), kAttributes.end(), name,
                                      [](const ContextAttribute& a, std::string_view n) { return a.name < n; });
  if (place == kAttributes.end() || place->name != name) return std::nullopt;
  return place->read(context);
}

bool is_of_part(std::string_view name) {
  // Those of edges and bays read the wall segment.
  return name.starts_with("building.") || name.starts_with("roof.") || name.starts_with("storey.");
}

std::vector<StoreyLook> storey_looks(const FacadeContext& context) {
  std::vector<StoreyLook> out;
  if (context.building.detail_overrides.empty()) return out;
  const std::vector<std::string> colours = by_storey(context, "colour"), materials = by_storey(context, "material");
  const model::Attributes& a = context.part.attributes;
  double low = a.ground_height.value + a.plinth_height.value - context.wall.base;
  const std::vector<double> heights = storey_heights(context);
  for (std::size_t i = 0; i < heights.size(); low += heights[i], ++i)
    if (!colours[i].empty() || !materials[i].empty())
      out.push_back({i, colours[i], materials[i], std::max(0.0, low), std::min(low + heights[i], eaves(context))});
  return out;
}

std::string edge_order(const FacadeContext& context, std::string_view key) { return overridden_edge(context, key); }

std::vector<std::string> unread_overrides(const model::Building& building) {
  using model::DetailKind;
  // What storey.*, bay.* and edge.kind read, and what paints walls.
  constexpr std::pair<DetailKind, std::string_view> kHeard[] = {{DetailKind::storey, "parameters.window"},
                                                                {DetailKind::storey, "height"},
                                                                {DetailKind::storey, "use"},
                                                                {DetailKind::storey, "colour"},
                                                                {DetailKind::storey, "material"},
                                                                {DetailKind::bay, "parameters.window"},
                                                                {DetailKind::bay, "parameters.use"},
                                                                {DetailKind::edge, "kind"},
                                                                {DetailKind::edge, "colour"},
                                                                {DetailKind::edge, "material"}};
  std::vector<std::string> out;
  for (const model::DetailOverride& d : building.detail_overrides)
    for (const auto& [key, value] : d.values)
      if (std::find(std::begin(kHeard), std::end(kHeard), std::pair(d.kind, std::string_view(key))) == std::end(kHeard))
        out.push_back(d.from + ": nothing reads " + key + " of a " + std::string(model::name(d.kind)));
  return out;
}

}  // namespace blockrand::facades
