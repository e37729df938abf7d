#include "pipeline/outputs/citygml/element_templates.h"

#include <algorithm>

#include "pipeline/outputs/citygml/geometry_text.h"
#include "pipeline/outputs/citygml/lean_element.h"
#include "pipeline/outputs/element_polygons.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/outputs/placed_element.h"
#include "pipeline/outputs/tile_digits.h"

namespace blockrand::outputs {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

/// The exterior and interiors of a polygon.
std::string rings_text(const ElementPolygon& polygon) {
  std::string out;
  for (const std::vector<ElementPoint>& ring : polygon.rings) {
    const bool outer = &ring == &polygon.rings.front();
    out += outer ? kExteriorBegin : kInteriorBegin;
    for (std::size_t i = 0; i <= ring.size(); ++i)
      for (const std::int64_t steps : ring[i == ring.size() ? 0 : i]) {
        append_ten_thousandths_of_a_metre(out, steps);
        out += ' ';
      }
    out.pop_back();
    out += outer ? kExteriorEnd : kInteriorEnd;
  }
  return out;
}

}  // namespace

ElementTemplates::ElementTemplates(const model::Region& region, int lod, bool lean) : prefix_("e") {
  append_base36(prefix_, number_of(region.tile));
  prefix_ += '_';
  template_of_.assign(region.elements.size(), kNone);
  if (lod < 3) return;
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    for (const model::BuildingPart& part : building.parts) {
      if (part.lod < 3 || part.lod3.solid.empty()) continue;
      for (const model::Placement& p : part.lod3.placements) {
        if (lean && p.opening != model::kNoOpening) continue;
        if (std::uint32_t& number = template_of_[p.element];
            number == kNone && has_shape(*region.elements.at(p.element).element))
          number = add(region.elements[p.element], lean);
      }
    }
  }
}

std::uint32_t ElementTemplates::add(const model::ColouredElement& coloured, bool lean) {
  Template made;
  std::vector<ElementPolygon> polygons = element_polygons(coloured);
  if (lean) polygons = without_small_pieces(std::move(polygons));
  for (const ElementPolygon& polygon : polygons) {
    const std::uint32_t look = MaterialNumbers::key(polygon.look.material, polygon.look.colour);
    const auto [place, added] = polygon_at_.emplace(std::to_string(look) + ' ' + rings_text(polygon), polygons_.size());
    if (added) polygons_.push_back({std::string_view(place->first).substr(place->first.find(' ') + 1)});
    auto group = std::find_if(made.groups.begin(), made.groups.end(), [&](const Group& g) { return g.look == look; });
    if (group == made.groups.end()) group = made.groups.insert(made.groups.end(), Group{look, {}});
    group->polygons.push_back(place->second);
  }
  std::vector<std::uint32_t> key;
  for (const Group& group : made.groups) key.insert(key.end(), group.polygons.begin(), group.polygons.end());
  const auto [place, added] = template_at_.emplace(key, templates_.size());
  if (added) {
    for (const std::uint32_t p : key) ++polygons_[p].uses;
    templates_.push_back(std::move(made));
  }
  return place->second;
}

void ElementTemplates::append_id(std::string& out, std::uint32_t id) const {
  out += prefix_;
  append_base36(out, id);
}

void ElementTemplates::append_polygon(std::string& out, Polygon& polygon) {
  if (polygon.id != 0) {
    out += "<surfaceMember xlink:href=\"#";
    append_id(out, polygon.id);
    out += "\"/>\n";
    return;
  }
  out += kPolygonBegin;
  if (polygon.uses > 1) {
    polygon.id = ++last_id_;
    out += " gml:id=\"";
    append_id(out, polygon.id);
    out += '"';
  }
  out += '>';
  out += polygon.rings;
  out += kPolygonEnd;
}

void ElementTemplates::append(std::string& out, std::uint32_t element, AppearanceText& appearance) {
  Template& written = templates_.at(template_of_.at(element));
  if (written.id != 0) {
    out += "<core:relativeGMLGeometry xlink:href=\"#";
    append_id(out, written.id);
    out += "\"/>";
    return;
  }
  const auto begin = [&](const char* name) {
    const std::uint32_t id = ++last_id_;
    out += name;
    out += " gml:id=\"";
    append_id(out, id);
    out += "\">";
    return id;
  };
  const auto paint = [&](std::uint32_t look, std::uint32_t id) {
    append_id(appearance.target(look), id);
    appearance.close();
  };
  written.id = begin("<core:relativeGMLGeometry><MultiSurface");
  for (const Group& group : written.groups) {
    const bool alone = written.groups.size() == 1;
    paint(group.look, alone ? written.id : begin("<surfaceMember><CompositeSurface"));
    for (const std::uint32_t p : group.polygons) append_polygon(out, polygons_[p]);
    if (!alone) out += "</CompositeSurface></surfaceMember>\n";
  }
  out += "</MultiSurface></core:relativeGMLGeometry>";
}

}  // namespace blockrand::outputs
