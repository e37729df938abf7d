#include "pipeline/outputs/cityjson/object_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/outputs/citygml/codes.h"

namespace blockrand::outputs {
namespace {

constexpr std::uint32_t kUnknown = 0xffffffff;

void append_index(std::string& out, std::uint32_t index) {
  char buffer[12];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof(buffer), index).ptr);
}

std::int64_t steps_between(double from, double to) {
  return static_cast<std::int64_t>(std::nearbyint((to - from) * model::kGridStepsPerMetre));
}

bool is_year(std::string_view text) {
  return text.size() == 4 && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
         text[0] != '0';
}

bool is_number(double value) { return std::isfinite(value); }
template <class T>
bool is_number(const T&) {
  return true;
}
bool is_given(const std::string& value) { return !value.empty(); }
template <class T>
bool is_given(const T&) {
  return true;
}

}  // namespace

GridPoint GridOrigin::steps(const model::Point3& p) const {
  return {steps_between(x, p.x), steps_between(y, p.y), steps_between(z, p.z)};
}

void Extent::add(const GridPoint& p) {
  if (empty) min = max = p;
  empty = false;
  min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
  max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
}

void append_extent(std::string& out, const Extent& extent, const GridOrigin& origin) {
  const auto metres = [&](std::int64_t steps, double from) {
    append_number(out, from + static_cast<double>(steps) / model::kGridStepsPerMetre);
  };
  out += '[';
  for (const GridPoint* p : {&extent.min, &extent.max}) {
    metres(p->x, origin.x);
    out += ',';
    metres(p->y, origin.y);
    out += ',';
    metres(p->z, origin.z);
    out += p == &extent.min ? ',' : ']';
  }
}

void append_material(std::string& out, const X3dMaterial& look) {
  out += "{\"name\":";
  append_json(out, look.name);
  out += ",\"diffuseColor\":[";
  append_ten_thousandths(out, look.diffuse, ',');
  out += "],\"specularColor\":[";
  append_ten_thousandths(out, look.specular, ',');
  out += "],\"shininess\":";
  append_ten_thousandths(out, look.shininess);
  out += '}';
}

void append_appearance(std::string& out, const MaterialNumbers& numbers,
                       const std::vector<model::MaterialClass>& classes) {
  out += "{\"default-theme-material\":\"";
  out += kVisualTheme;
  out += "\",\"materials\":[";
  bool first = true;
  for (const std::uint32_t key : numbers.keys()) {
    const X3dMaterial look = x3d_material(classes.at(MaterialNumbers::material(key)), MaterialNumbers::colour(key));
    if (!first) out += ',';
    first = false;
    append_material(out, look);
  }
  out += "]}";
}

ObjectText::ObjectText(const model::Region& region, const CityJsonOptions& options, const GridOrigin& origin,
                       VertexTable& vertices, MaterialNumbers& materials, const std::vector<std::uint32_t>& templates)
    : region_(region),
      options_(options),
      origin_(origin),
      vertices_(vertices),
      materials_(materials),
      tags_(region.extract),
      templates_(templates) {}

void ObjectText::append(std::string& out, const model::Building& building, const std::vector<std::uint8_t>& class_of) {
  out_ = &out;
  class_of_ = &class_of;
  const std::string id = building.id();
  const bool single = building.parts.size() == 1 && building.parts.front().id == id;
  const auto part_id = [&](const model::BuildingPart& part) { return part.id == id ? id + ".1" : part.id; };
  append_json(out, id);
  out += ":{\"type\":\"Building\"";
  object(building, single ? &building.parts.front() : nullptr, true);
  const auto children = [&](const std::vector<std::string>& ids) {
    if (ids.empty()) return;
    out += ",\"children\":[";
    for (const std::string& child : ids) {
      if (&child != &ids.front()) out += ',';
      append_json(out, child);
    }
    out += ']';
  };
  if (single) {
    children(installation_ids(building.parts.front(), id));
    out += '}';
    installations(building.parts.front(), id);
    return;
  }
  std::vector<std::string> part_ids;
  for (const model::BuildingPart& part : building.parts) part_ids.push_back(part_id(part));
  children(part_ids);
  out += '}';
  for (const model::BuildingPart& part : building.parts) {
    out += ',';
    append_json(out, part_id(part));
    out += ":{\"type\":\"BuildingPart\",\"parents\":[";
    append_json(out, id);
    out += ']';
    object(building, &part, false);
    children(installation_ids(part, part_id(part)));
    out += '}';
    installations(part, part_id(part));
  }
}

/// The members of a city object after its type: of a whole building (with the geometry of `part`, if it is its only
/// one), or of a part.
void ObjectText::object(const model::Building& building, const model::BuildingPart* part, bool whole) {
  // A remainder or a piece of the outline carries the building's tags, which stand there.
  const bool own_tags = whole || part->osm != building.osm;
  const model::OsmId& osm = whole ? building.osm : part->osm;
  const model::Range tags = !own_tags ? model::Range{} : whole ? building.tags : part->tags;
  *out_ += ",\"attributes\":{";
  first_ = true;
  if (const std::string_view name = tags_.name(tags); !name.empty()) text("name", name);
  if (const std::string page = osm_page(osm); !page.empty()) text("externalReference", page);
  attributes(part ? part->attributes : building.attributes, tags, part);
  if (building.replaced) {
    text("origin", "replaced");
    text("replaced_by", model::text(*building.replaced));
  }
  if (whole) imagery(building.osm);
  *out_ += '}';
  address(tags);
  if (part) geometry(*part);
}

void ObjectText::imagery(model::OsmId id) {
  const std::optional<SeenOutline> seen = options_.seen ? options_.seen(id) : std::nullopt;
  if (!seen) return;
  for (const auto& [name, value] : imagery_attributes(*seen)) {
    if (const double* v = std::get_if<double>(&value))
      number(name, *v);
    else
      text(name, std::get<std::string>(value));
  }
}

void ObjectText::key(std::string_view name, std::string_view suffix) {
  if (!first_) *out_ += ',';
  first_ = false;
  *out_ += '"';
  *out_ += name;
  *out_ += suffix;
  *out_ += "\":";
}

void ObjectText::text(std::string_view name, std::string_view value, std::string_view suffix) {
  if (value.empty()) return;
  key(name, suffix);
  append_json(*out_, value);
}

void ObjectText::number(std::string_view name, double value) {
  key(name);
  append_number(*out_, value);
}

void ObjectText::attributes(const model::Attributes& a, model::Range tags, const model::BuildingPart* part) {
  model::for_each_attribute(
      a,
      [&](std::string_view name, std::string_view, const auto& sourced) {
        if (is_number(sourced.value) && is_given(sourced.value)) {
          key(name);
          value(sourced.value);
        }
        text(name, model::name(sourced.source), "_source");
        key(name, "_confidence");
        append_number(*out_, sourced.confidence);
        if (options_.evidence && sourced.evidence != 0)
          text(name, region_.evidence[sourced.evidence].text, "_evidence");
      },
      [](std::string_view, std::string_view) {});
  if (part) {
    text("built_roof", model::name(part->built_roof));
    key("lod");
    append_number(*out_, static_cast<std::int64_t>(part->lod));
    if (!part->fallbacks.empty()) {
      key("fallbacks");
      *out_ += '"';
      for (std::size_t i = 0; i < part->fallbacks.size(); ++i) {
        if (i) *out_ += ' ';
        *out_ += model::info(part->fallbacks[i]).text;
      }
      *out_ += '"';
    }
  }
  if (region_.extract)
    for (const model::Tag& tag : region_.extract->tags_of(tags)) {
      *out_ += first_ ? "" : ",";
      first_ = false;
      std::string name = "osm.";
      name += region_.extract->strings.view(tag.key);
      append_json(*out_, name);
      *out_ += ':';
      append_json(*out_, region_.extract->strings.view(tag.value));
    }
  standard_attributes(a, tags, part);
}

/// The names that readers of other CityJSON files look for; the elements of bldg:_AbstractBuilding.
void ObjectText::standard_attributes(const model::Attributes& a, model::Range tags, const model::BuildingPart* part) {
  constexpr double kMostStoreys = 1000;  // longer lists of heights would be nonsense
  text("class", class_code(a.use.value));
  text("function", a.use.value);
  text("usage", tags_.building_use(tags));
  if (const std::string_view date = tags_.start_date(tags); is_year(date)) {
    key("yearOfConstruction");
    *out_ += date;
  }
  if (part) text("roofType", roof_type_code(part->built_roof));
  if (std::isfinite(a.height.value)) number("measuredHeight", a.height.value);
  const double storeys = a.storeys.value;
  if (!(storeys >= 0 && storeys <= kMostStoreys && storeys == std::floor(storeys))) return;
  number("storeysAboveGround", storeys);
  if (storeys < 1 || !std::isfinite(a.storey_height.value)) return;
  key("storeyHeightsAboveGround");
  for (int i = 0; i < static_cast<int>(storeys); ++i) {
    *out_ += i ? ',' : '[';
    append_number(*out_, a.storey_height.value);
  }
  *out_ += ']';
}

void ObjectText::address(model::Range tags) {
  const Address a = tags_.address(tags);
  if (a.city.empty() && a.suburb.empty() && a.postcode.empty() && a.street.empty() && a.place.empty() &&
      a.house_number.empty() && a.house_name.empty())
    return;
  *out_ += ",\"address\":[{";
  first_ = true;
  text("Country", a.country);
  text("Locality", a.city);
  text("DependentLocality", a.suburb);
  text("Postcode", a.postcode);
  text("ThoroughfareName", a.street.empty() ? a.place : a.street);
  text("ThoroughfareNumber", a.house_number.empty() ? a.house_name : a.house_number);
  *out_ += "}]";
}

void ObjectText::geometry(const model::BuildingPart& part) {
  const bool lod1 = options_.lod >= 1 && part.lod >= 1 && !part.lod1.empty();
  const bool lod2 = options_.lod >= 2 && part.lod >= 2 && !part.lod2.empty();
  *out_ += ",\"geometry\":[";
  first_ = true;
  if (part.plan.outer.size() >= 3) footprint(part);
  if (lod1) solid(part.lod1, 1, !lod2);
  if (lod2) solid(part.lod2, 2, true);
  if (lod2 && has_detail(part)) detail_solid(part.lod3);
  *out_ += ']';
}

void ObjectText::ring(const model::Ring& plan, bool counter_clockwise, double z) {
  model::Ring ring = plan;
  geometry::orient(ring, counter_clockwise);
  *out_ += '[';
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    if (i) *out_ += ',';
    append_index(*out_, vertices_.number(origin_.steps({ring.points[i].x, ring.points[i].y, z})));
  }
  *out_ += ']';
}

void ObjectText::footprint(const model::BuildingPart& part) {
  const double ground = part.attributes.ground_height.value;
  const double z = std::isfinite(ground) ? model::snap(ground) : 0;
  *out_ += "{\"type\":\"MultiSurface\",\"lod\":\"0\",\"boundaries\":[[";
  ring(part.plan.outer, true, z);
  for (const model::Ring& hole : part.plan.holes) {
    *out_ += ',';
    ring(hole, false, z);
  }
  // The semantics tell a footprint from a roof's outline, which is LoD 0 as well.
  *out_ += "]],\"semantics\":{\"surfaces\":[{\"type\":\"GroundSurface\"}],\"values\":[0]}}";
  first_ = false;
}

void ObjectText::solid(const model::Solid& solid, int lod, bool materials) {
  std::string& out = *out_;
  if (!first_) out += ',';
  first_ = false;
  out += solid.closed ? "{\"type\":\"Solid\",\"lod\":\"" : "{\"type\":\"MultiSurface\",\"lod\":\"";
  out += static_cast<char>('0' + lod);
  out += '"';
  boundaries(solid);
  if (lod >= 2) {
    // One semantic object per kind, in order of first appearance.
    std::uint32_t number[model::kSurfaceKindCount], count = 0;
    std::fill(std::begin(number), std::end(number), kUnknown);
    out += ",\"semantics\":{\"surfaces\":[";
    for (const model::Face& face : solid.faces) {
      std::uint32_t& n = number[static_cast<std::size_t>(face.kind)];
      if (n != kUnknown) continue;
      out += count ? ",{\"type\":\"" : "{\"type\":\"";
      out += semantic_name(face.kind);
      out += "\"}";
      n = count++;
    }
    out += solid.closed ? "],\"values\":[[" : "],\"values\":[";
    for (std::size_t f = 0; f < solid.faces.size(); ++f) {
      if (f) out += ',';
      append_index(out, number[static_cast<std::size_t>(solid.faces[f].kind)]);
    }
    out += solid.closed ? "]]}" : "]}";
  }
  if (materials) solid_material(solid);
  out += '}';
}

void ObjectText::boundaries(const model::Solid& solid) {
  std::string& out = *out_;
  numbers_.assign(solid.vertices.size(), kUnknown);
  out += solid.closed ? ",\"boundaries\":[[" : ",\"boundaries\":[";
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    out += f ? ",[" : "[";
    bool first_loop = true;
    for (const model::Solid::Loop& loop : solid.loops_of(solid.faces[f])) {
      out += first_loop ? "[" : ",[";
      first_loop = false;
      bool first_index = true;
      for (const std::uint32_t v : solid.indices_of(loop)) {
        if (!first_index) out += ',';
        first_index = false;
        if (numbers_[v] == kUnknown) numbers_[v] = vertices_.number(origin_.steps(solid.vertices[v]));
        append_index(out, numbers_[v]);
      }
      out += ']';
    }
    out += ']';
  }
  out += solid.closed ? "]]" : "]";
}

void ObjectText::solid_material(const model::Solid& solid) {
  std::string& out = *out_;
  out += ",\"material\":{\"";
  out += kVisualTheme;
  out += solid.closed ? "\":{\"values\":[[" : "\":{\"values\":[";
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    if (f) out += ',';
    const model::Face& face = solid.faces[f];
    append_index(out, materials_.number(MaterialNumbers::key(class_of_->at(face.material), face.colour)));
  }
  out += solid.closed ? "]]}}" : "]}}";
}

}  // namespace blockrand::outputs
