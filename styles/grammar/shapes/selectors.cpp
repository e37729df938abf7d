// Which component a selector takes (docs/rule_language.md §2.4).
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

struct Direction {
  std::string_view name;
  Vector3 way;
};
constexpr std::array<Direction, 6> kScopeDirections{{{"top", {0, 1, 0}},
                                                     {"bottom", {0, -1, 0}},
                                                     {"left", {-1, 0, 0}},
                                                     {"right", {1, 0, 0}},
                                                     {"front", {0, 0, 1}},
                                                     {"back", {0, 0, -1}}}};
constexpr std::array<Direction, 6> kWorldDirections{{{"up", {0, 1, 0}},
                                                     {"down", {0, -1, 0}},
                                                     {"west", {-1, 0, 0}},
                                                     {"east", {1, 0, 0}},
                                                     {"south", {0, 0, 1}},
                                                     {"north", {0, 0, -1}}}};
struct Named {
  std::string_view name;
  Selector::Kind kind;
};
constexpr std::array<Named, 14> kNamed{{{"all", Selector::Kind::all},
                                        {"side", Selector::Kind::side},
                                        {"vertical", Selector::Kind::vertical},
                                        {"horizontal", Selector::Kind::horizontal},
                                        {"aslant", Selector::Kind::aslant},
                                        {"nutant", Selector::Kind::nutant},
                                        {"border", Selector::Kind::border},
                                        {"inside", Selector::Kind::inside},
                                        {"eave", Selector::Kind::eave},
                                        {"hip", Selector::Kind::hip},
                                        {"valley", Selector::Kind::valley},
                                        {"ridge", Selector::Kind::ridge},
                                        {"remainder", Selector::Kind::remainder},
                                        {"shape", Selector::Kind::shape}}};

template <std::size_t N>
const Direction* find(const std::array<Direction, N>& table, std::string_view name) {
  for (const Direction& d : table)
    if (d.name == name) return &d;
  return nullptr;
}

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const auto dot_at = text.find('.');
    out.push_back(text.substr(0, dot_at));
    text = dot_at == std::string_view::npos ? std::string_view{} : text.substr(dot_at + 1);
  }
  return out;
}

bool match_parts(std::span<const std::string_view> query, std::span<const std::string_view> tag) {
  if (query.empty()) return true;  // deeper tags match, too
  if (tag.empty()) return false;
  if (query[0] == "*") {
    for (std::size_t n = 1; n <= tag.size(); ++n)
      if (match_parts(query.subspan(1), tag.subspan(n))) return true;
    return false;
  }
  if (query[0] != "?" && query[0] != tag[0]) return false;
  return match_parts(query.subspan(1), tag.subspan(1));
}

/// True where the direction's greatest part points along `way` (an axis): 45 degree quadrants.
bool dominant(Vector3 normal, Vector3 way) {
  const double along = dot(normal, way);
  if (!(along > 0)) return false;
  constexpr double kTie = 1e-9;
  return along + kTie >= std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)});
}

Vector3 in_space(const Shape& shape, Vector3 normal, Selector::Space space) {
  if (space == Selector::Space::scope) return normal;
  const Vector3 object = turn(scope_in_object(shape), normal);
  return space == Selector::Space::object ? object : turn(object_in_world(shape), object);
}

/// In quadrants about the world's or scope's y, from the direction that front is.
bool street_selected(const Shape& shape, Vector3 normal, const Selector& selector) {
  const Vector3 object = in_space(shape, normal, Selector::Space::object);
  const Origin* origin = shape.origin.get();
  const bool known = origin != nullptr && !origin->street_widths.empty() &&
                     origin->street_widths.size() <= origin->edge_normals.size();
  if (!known) {  // as object.*
    if (selector.query == "side") return !dominant(object, {0, 1, 0}) && !dominant(object, {0, -1, 0});
    const Direction* way = find(kScopeDirections, selector.query);
    return way != nullptr && dominant(object, way->way);
  }
  if (dominant(object, {0, 1, 0}) || dominant(object, {0, -1, 0})) return false;
  const auto& widths = origin->street_widths;
  if (selector.query == "side") {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < widths.size(); ++i)
      if (dot(object, origin->edge_normals[i]) > dot(object, origin->edge_normals[nearest]) + 1e-9) nearest = i;
    return widths[nearest] > 0;
  }
  std::size_t widest = 0;
  for (std::size_t i = 1; i < widths.size(); ++i)
    if (widths[i] > widths[widest]) widest = i;
  const Frame frame = frame_with_y({}, {0, 1, 0}, cross({0, 1, 0}, origin->edge_normals[widest]));
  const Direction* way = find(kScopeDirections, selector.query);
  return way != nullptr && dominant(turn_back(frame, object), way->way);
}

bool set_matches(const Mesh& mesh, std::uint16_t tags, std::string_view query) {
  for (const std::string& tag : mesh.tag_sets[tags])
    if (tag_matches(query, tag)) return true;
  return false;
}

bool tagged(const ComponentSplit& split, const Component& item, const Selector& selector) {
  const Mesh& mesh = mesh_of(split.parent);
  const auto face_tagged = [&](std::uint32_t f) { return set_matches(mesh, mesh.faces[f].tags, selector.query); };
  const auto an_edge_of = [&](std::uint32_t f) {
    for (const Loop& loop : mesh.faces[f].loops)
      for (const Corner c : loop)
        if (set_matches(mesh, c.edge_tags, selector.query)) return true;
    return false;
  };
  const bool want_edges = selector.tag_of != ComponentKind::faces;
  switch (split.kind) {
    case ComponentKind::faces:
      return want_edges ? an_edge_of(item.face) : face_tagged(item.face);
    case ComponentKind::groups:
    case ComponentKind::materials:
      return std::any_of(item.faces.begin(), item.faces.end(), face_tagged);
    case ComponentKind::holes:
      return face_tagged(item.face);
    case ComponentKind::edges:
    case ComponentKind::face_edges:
    case ComponentKind::vertices:
    case ComponentKind::face_vertices:
      break;
  }
  // Edges and vertices: their own tags, and those of their faces.
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (const Loop& loop : mesh.faces[f].loops)
      for (std::size_t c = 0; c < loop.size(); ++c) {
        const std::uint32_t a = loop[c].vertex, b = loop[(c + 1) % loop.size()].vertex;
        const bool here =
            split.kind == ComponentKind::vertices || split.kind == ComponentKind::face_vertices
                ? a == item.vertex_a || b == item.vertex_a
                : (a == item.vertex_a && b == item.vertex_b) || (a == item.vertex_b && b == item.vertex_a);
        const bool own_face =
            split.kind == ComponentKind::edges || split.kind == ComponentKind::vertices || f == item.face;
        if (here && own_face && (set_matches(mesh, loop[c].edge_tags, selector.query) || face_tagged(f))) return true;
      }
  return false;
}

/// uv.left … of a face edge: where it lies in the set's box over the face.
bool uv_selected(const ComponentSplit& split, const Component& item, const Selector& selector) {
  const auto* uv = uv_of(mesh_of(split.parent), 0, item.face);
  if (uv == nullptr || item.loop >= uv->size()) return false;
  const auto& ring = (*uv)[item.loop];
  if (ring.empty()) return false;
  Vector2 low = (*uv)[0][0], high = low;
  for (const auto& loop : *uv)
    for (const Vector2 p : loop) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  const Vector2 a = ring[item.corner % ring.size()], b = ring[(item.corner + 1) % ring.size()];
  const double reach_u = 1e-4 * (high.x - low.x), reach_v = 1e-4 * (high.y - low.y);
  const auto near = [](double p, double q, double at, double reach) {
    return std::fabs(p - at) <= reach && std::fabs(q - at) <= reach;
  };
  if (selector.query == "uMin") return near(a.x, b.x, low.x, reach_u);
  if (selector.query == "uMax") return near(a.x, b.x, high.x, reach_u);
  if (selector.query == "vMin") return near(a.y, b.y, low.y, reach_v);
  if (selector.query == "vMax") return near(a.y, b.y, high.y, reach_v);
  // left, right, bottom, top: by the outward direction in uv space.
  double area = 0;
  for (std::size_t i = 0; i < (*uv)[0].size(); ++i) {
    const Vector2 p = (*uv)[0][i], q = (*uv)[0][(i + 1) % (*uv)[0].size()];
    area += p.x * q.y - p.y * q.x;
  }
  const double turn = area < 0 ? -1 : 1;
  const double out_u = (b.y - a.y) * turn, out_v = -(b.x - a.x) * turn;
  const bool along_u = std::fabs(out_u) >= std::fabs(out_v);
  if (selector.query == "left") return along_u && out_u < 0;
  if (selector.query == "right") return along_u && out_u > 0;
  if (selector.query == "bottom") return !along_u && out_v < 0;
  return selector.query == "top" && !along_u && out_v > 0;
}

}  // namespace

bool tag_matches(std::string_view query, std::string_view tag) {
  const auto wanted = parts_of(query), parts = parts_of(tag);
  return match_parts(wanted, parts);
}

std::optional<Selector> selector_of_word(std::string_view word) {
  Selector out;
  out.text = std::string(word);
  for (const Named& named : kNamed)
    if (named.name == word) {
      out.kind = named.kind;
      return out;
    }
  const auto directed = [&](const Direction* way, Selector::Space space) -> std::optional<Selector> {
    if (way == nullptr) return {};
    out.kind = Selector::Kind::direction;
    out.space = space;
    out.direction = way->way;
    return out;
  };
  const auto dot_at = word.find('.');
  if (dot_at == std::string_view::npos) {
    if (word == "streetSide" || word == "noStreetSide") {  // names before 2012
      out.kind = Selector::Kind::street;
      out.query = word == "streetSide" ? "side" : "no";
      return out;
    }
    return directed(find(kScopeDirections, word), Selector::Space::scope);
  }
  const std::string_view space = word.substr(0, dot_at), name = word.substr(dot_at + 1);
  if (space == "object" || space == "world" || space == "scope") {
    const auto frame = space == "object"  ? Selector::Space::object
                       : space == "world" ? Selector::Space::world
                                          : Selector::Space::scope;
    if (name == "side") {
      out.kind = Selector::Kind::side;
      out.space = frame;
      return out;
    }
    return directed(space == "world" ? find(kWorldDirections, name) : find(kScopeDirections, name), frame);
  }
  if (space == "street" &&
      (name == "side" || (find(kScopeDirections, name) != nullptr && name != "top" && name != "bottom"))) {
    out.kind = Selector::Kind::street;
    out.query = std::string(name);
    return out;
  }
  constexpr std::array<std::string_view, 8> kUv{"left", "right", "top", "bottom", "uMin", "uMax", "vMin", "vMax"};
  if (space == "uv" && std::find(kUv.begin(), kUv.end(), name) != kUv.end()) {
    out.kind = Selector::Kind::uv;
    out.query = std::string(name);
    return out;
  }
  return {};
}

Selector selector_of_index(double index) {
  Selector out;
  out.kind = Selector::Kind::index;
  out.index = index;
  const auto whole = static_cast<long long>(std::isfinite(index) && std::fabs(index) < 1e15 ? index : 0);
  out.text = std::to_string(whole);
  return out;
}

Selector selector_of_tag(std::string_view query, std::string_view components) {
  Selector out;
  out.kind = Selector::Kind::tagged;
  out.query = std::string(query);
  if (const auto kind = component_kind(components)) out.tag_of = *kind;
  out.text = "isTagged(\"" + out.query + "\")";
  return out;
}

bool direction_selected(const Shape& shape, Vector3 normal, const Selector& selector) {
  using Kind = Selector::Kind;
  // Sine of the height of the normal above the scope's xz plane against those of 11.25 and 78.75 degrees.
  constexpr double kFlat = 0.98078528040323044913, kUpright = 0.19509032201612826785;
  switch (selector.kind) {
    case Kind::all:
      return true;
    case Kind::direction:
      return dominant(in_space(shape, normal, selector.space), selector.direction);
    case Kind::side: {
      if (normal == Vector3{}) return false;
      if (selector.space == Selector::Space::scope) return std::fabs(normal.y) <= kFlat;
      const Vector3 n = in_space(shape, normal, selector.space);
      return !dominant(n, {0, 1, 0}) && !dominant(n, {0, -1, 0});
    }
    case Kind::horizontal:
      return normal != Vector3{} && std::fabs(normal.y) > kFlat;
    case Kind::aslant:
      return normal.y > kUpright && normal.y <= kFlat;
    case Kind::vertical:
      return normal != Vector3{} && normal.y > -kUpright && normal.y <= kUpright;
    case Kind::nutant:
      return normal.y >= -kFlat && normal.y <= -kUpright;
    case Kind::street: {
      if (selector.query != "no") return street_selected(shape, normal, selector);
      Selector side = selector;
      side.query = "side";
      const Vector3 object = in_space(shape, normal, Selector::Space::object);
      return !dominant(object, {0, 1, 0}) && !dominant(object, {0, -1, 0}) && !street_selected(shape, normal, side);
    }
    case Kind::none:
    case Kind::border:
    case Kind::inside:
    case Kind::eave:
    case Kind::hip:
    case Kind::valley:
    case Kind::ridge:
    case Kind::index:
    case Kind::tagged:
    case Kind::uv:
    case Kind::remainder:
    case Kind::shape:
      break;
  }
  return false;
}

bool selected(const ComponentSplit& split, std::size_t item, const Selector& selector) {
  using Kind = Selector::Kind;
  if (item >= split.items.size()) return false;
  const Component& component = split.items[item];
  const bool is_edge = split.kind == ComponentKind::edges || split.kind == ComponentKind::face_edges;
  switch (selector.kind) {
    case Kind::border:
      return component.border;
    case Kind::inside:
      return !component.border;
    case Kind::eave:
    case Kind::hip:
    case Kind::valley:
    case Kind::ridge:
      return is_edge && component.roof_edge == selector.kind;
    case Kind::index: {
      const auto count = static_cast<double>(split.items.size());
      const double wanted = std::floor(selector.index);
      return static_cast<double>(item) == (wanted < 0 ? wanted + count : wanted);
    }
    case Kind::tagged:
      return tagged(split, component, selector);
    case Kind::uv:
      return split.kind == ComponentKind::face_edges && uv_selected(split, component, selector);
    case Kind::all:
    case Kind::none:
    case Kind::direction:
    case Kind::side:
    case Kind::vertical:
    case Kind::horizontal:
    case Kind::aslant:
    case Kind::nutant:
    case Kind::street:
    case Kind::remainder:
    case Kind::shape:
      break;
  }
  return direction_selected(split.parent, component.normal, selector);
}

}  // namespace blockrand::grammar
