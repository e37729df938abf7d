// LoD3 of city objects: the solid with windows and doors, installations, elements as instances of templates.
#include <algorithm>
#include <cmath>

#include "pipeline/outputs/cityjson/object_text.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {
namespace {

void append_index(std::string& out, std::size_t index) { append_number(out, static_cast<std::int64_t>(index)); }

/// Places of one kind of element, in order of first appearance.
struct Kind {
  std::string_view name;
  std::vector<const model::Placement*> places;
};

std::vector<Kind> kinds_of(const model::Region& region, const model::Detail& detail) {
  std::vector<Kind> out;
  for (const model::Placement& p : detail.placements) {
    if (!has_shape(*region.elements.at(p.element).element)) continue;
    const std::string_view name = region.elements.at(p.element).element->kind;
    auto kind = std::find_if(out.begin(), out.end(), [&](const Kind& k) { return k.name == name; });
    if (kind == out.end()) kind = out.insert(out.end(), {name, {}});
    kind->places.push_back(&p);
  }
  return out;
}

/// As in CityGML, where elements on walls are counted before them.
std::size_t first_body_number(const model::Region& region, const model::Detail& detail) {
  return static_cast<std::size_t>(
      std::count_if(detail.placements.begin(), detail.placements.end(), [&](const model::Placement& p) {
        return p.opening == model::kNoOpening && has_shape(*region.elements.at(p.element).element);
      }));
}

std::string body_id(const std::string& id, std::size_t number) {
  std::string out = id + "_i";
  append_index(out, number);
  return out;
}

}  // namespace

std::string_view semantic_name(model::SurfaceKind kind) {
  constexpr std::string_view names[model::kSurfaceKindCount] = {
      "GroundSurface",     "WallSurface",    "RoofSurface", "OuterCeilingSurface",
      "OuterFloorSurface", "ClosureSurface", "Window",      "Door"};
  return names[static_cast<std::size_t>(kind)];
}

void ObjectText::detail_solid(const model::Detail& detail) {
  constexpr std::uint32_t kUnknown = 0xffffffff;
  const model::Solid& solid = detail.solid;
  std::string& out = *out_;
  if (!first_) out += ',';
  first_ = false;
  out += solid.closed ? "{\"type\":\"Solid\",\"lod\":\"3\"" : "{\"type\":\"MultiSurface\",\"lod\":\"3\"";
  boundaries(solid);

  // A wall with openings is a surface of its own, with its reveals; each opening is one below it. The others are one
  // for each kind.
  struct Semantic {
    model::SurfaceKind kind = model::SurfaceKind::wall;
    std::uint32_t parent = kUnknown;
    std::vector<std::uint32_t> children;
    std::string_view rule = {};  ///< whose faces they are
  };
  std::vector<Semantic> semantics;
  std::vector<std::uint32_t> of_face(solid.faces.size(), kUnknown);
  for (const model::Opening& o : detail.openings) {
    if (o.kind == model::OpeningKind::passage) continue;
    if (of_face[o.wall] == kUnknown) {
      of_face[o.wall] = static_cast<std::uint32_t>(semantics.size());
      semantics.push_back({solid.faces[o.wall].kind, kUnknown, {}});
    }
    const std::uint32_t wall = of_face[o.wall], own = static_cast<std::uint32_t>(semantics.size());
    for (std::uint32_t i = 0; i < o.reveal_count; ++i) of_face[o.first_reveal + i] = wall;
    of_face[o.polygon] = own;
    semantics[wall].children.push_back(own);
    semantics.push_back({solid.faces[o.polygon].kind, wall, {}});
  }
  for (const model::RuleFaces& rule : detail.rules) {
    std::uint32_t of_kind[model::kSurfaceKindCount];
    std::fill(std::begin(of_kind), std::end(of_kind), kUnknown);
    for (std::uint32_t f = rule.first; f < rule.first + rule.count; ++f) {
      std::uint32_t& n = of_kind[static_cast<std::size_t>(solid.faces[f].kind)];
      if (n == kUnknown) {
        n = static_cast<std::uint32_t>(semantics.size());
        semantics.push_back({solid.faces[f].kind, kUnknown, {}, rule.rule});
      }
      of_face[f] = n;
    }
  }
  std::uint32_t of_kind[model::kSurfaceKindCount];
  std::fill(std::begin(of_kind), std::end(of_kind), kUnknown);
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    if (of_face[f] != kUnknown) continue;
    std::uint32_t& n = of_kind[static_cast<std::size_t>(solid.faces[f].kind)];
    if (n == kUnknown) {
      n = static_cast<std::uint32_t>(semantics.size());
      semantics.push_back({solid.faces[f].kind, kUnknown, {}});
    }
    of_face[f] = n;
  }
  out += ",\"semantics\":{\"surfaces\":[";
  for (std::size_t i = 0; i < semantics.size(); ++i) {
    out += i ? ",{\"type\":\"" : "{\"type\":\"";
    out += semantic_name(semantics[i].kind);
    out += '"';
    if (!semantics[i].rule.empty()) {
      out += ",\"rule\":";
      append_json(out, semantics[i].rule);
    }
    if (semantics[i].parent != kUnknown) {
      out += ",\"parent\":";
      append_index(out, semantics[i].parent);
    }
    if (!semantics[i].children.empty()) {
      out += ",\"children\":[";
      for (std::size_t c = 0; c < semantics[i].children.size(); ++c) {
        if (c) out += ',';
        append_index(out, semantics[i].children[c]);
      }
      out += ']';
    }
    out += '}';
  }
  out += solid.closed ? "],\"values\":[[" : "],\"values\":[";
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    if (f) out += ',';
    append_index(out, of_face[f]);
  }
  out += solid.closed ? "]]}" : "]}";
  solid_material(solid);
  out += '}';
}

std::vector<std::string> ObjectText::installation_ids(const model::BuildingPart& part, const std::string& id) const {
  std::vector<std::string> out;
  if (!has_detail(part)) return out;
  for (const Kind& kind : kinds_of(region_, part.lod3)) out.push_back(id + "_" + std::string(kind.name));
  const std::size_t first = first_body_number(region_, part.lod3),
                    count = part.lod3.installations.size() + part.lod3.roof_installations.size();
  for (std::size_t i = 0; i < count; ++i) out.push_back(body_id(id, first + i));
  return out;
}

void ObjectText::installations(const model::BuildingPart& part, const std::string& id) {
  if (!has_detail(part)) return;
  std::string& out = *out_;
  for (const Kind& kind : kinds_of(region_, part.lod3)) {
    open_installation(id + "_" + std::string(kind.name), id, kind.name);
    for (const model::Placement* p : kind.places) {
      if (p != kind.places.front()) out += ',';
      instance(*p);
    }
    out += "]}";
  }
  std::size_t number = first_body_number(region_, part.lod3);
  const auto body = [&](const model::Solid& solid, std::string_view kind) {
    open_installation(body_id(id, number++), id, kind);
    out += "{\"type\":\"Solid\",\"lod\":\"3\"";
    boundaries(solid);
    solid_material(solid);
    out += "}]}";
  };
  for (const model::WallInstallation& i : part.lod3.installations) body(i.solid, i.kind);
  for (const model::RoofInstallation& i : part.lod3.roof_installations) body(i.solid, model::name(i.kind));
}

void ObjectText::open_installation(const std::string& id, const std::string& parent, std::string_view kind) {
  std::string& out = *out_;
  out += ',';
  append_json(out, id);
  out += ":{\"type\":\"BuildingInstallation\",\"parents\":[";
  append_json(out, parent);
  out += "],\"attributes\":{\"function\":";
  append_json(out, kind);
  out += "},\"geometry\":[";
}

void ObjectText::instance(const model::Placement& p) {
  std::string& out = *out_;
  out += "{\"type\":\"GeometryInstance\",\"template\":";
  append_index(out, templates_.at(p.element));
  out += ",\"boundaries\":[";
  append_index(out, vertices_.number(origin_.steps(p.origin)));
  out += "],\"transformationMatrix\":[";
  const auto number = [&](double v) {
    append_number(out, std::nearbyint(v * 1e9) / 1e9 + 0.0);
    out += ',';
  };
  number(p.along.x);
  number(0 - p.along.y);
  out += "0,0,";
  number(p.along.y);
  number(p.along.x);
  out += "0,0,0,0,1,0,0,0,0,1]}";
}

}  // namespace blockrand::outputs
