#include "pipeline/outputs/cityjson/template_table.h"

#include <map>

#include "pipeline/outputs/element_polygons.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {
namespace {

void append_index(std::string& out, std::size_t index) { append_number(out, static_cast<std::int64_t>(index)); }

}  // namespace

std::vector<std::uint32_t> TemplateTable::add(const model::Region& region, const std::vector<std::uint8_t>& class_of) {
  std::vector<std::uint32_t> out(region.elements.size(), kNoTemplate);
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    for (const model::BuildingPart& part : building.parts) {
      if (part.lod < 3 || part.lod3.solid.empty()) continue;
      for (const model::Placement& p : part.lod3.placements)
        if (std::uint32_t& n = out[p.element]; n == kNoTemplate && has_shape(*region.elements.at(p.element).element))
          n = number(region.elements[p.element], class_of);
    }
  }
  return out;
}

std::uint32_t TemplateTable::number(const model::ColouredElement& coloured, const std::vector<std::uint8_t>& class_of) {
  std::vector<std::string> points;
  std::map<ElementPoint, std::size_t> known;
  const auto vertex = [&](const ElementPoint& p) {
    const auto [place, added] = known.emplace(p, points.size());
    if (!added) return place->second;
    std::string text = "[";
    for (const std::int64_t steps : p) {
      append_ten_thousandths_of_a_metre(text, steps);
      text += ',';
    }
    text.back() = ']';
    points.push_back(std::move(text));
    return place->second;
  };
  std::vector<std::vector<std::vector<std::size_t>>> faces;
  std::vector<std::uint32_t> looks;
  std::string key;
  for (const ElementPolygon& polygon : element_polygons(coloured)) {
    looks.push_back(materials_.number(MaterialNumbers::key(class_of.at(polygon.look.material), polygon.look.colour)));
    append_index(key, looks.back());
    auto& rings = faces.emplace_back();
    for (const std::vector<ElementPoint>& ring : polygon.rings) {
      auto& indices = rings.emplace_back();
      key += ',';
      for (const ElementPoint& p : ring) {
        indices.push_back(vertex(p));
        key += ' ';
        append_index(key, indices.back());
      }
    }
    key += ';';
  }
  for (const std::string& p : points) key += p;
  const auto [place, added] = numbers_.emplace(std::move(key), static_cast<std::uint32_t>(numbers_.size()));
  if (!added) return place->second;

  templates_ += templates_.empty() ? "" : ",";
  templates_ += "{\"type\":\"MultiSurface\",\"lod\":\"3\",\"boundaries\":[";
  for (const auto& rings : faces) {
    templates_ += &rings == &faces.front() ? "[" : ",[";
    for (const auto& ring : rings) {
      templates_ += &ring == &rings.front() ? "[" : ",[";
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (i > 0) templates_ += ',';
        append_index(templates_, vertex_count_ + ring[i]);
      }
      templates_ += ']';
    }
    templates_ += ']';
  }
  templates_ += "],\"material\":{\"";
  templates_ += kVisualTheme;
  templates_ += "\":{\"values\":[";
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (i > 0) templates_ += ',';
    append_index(templates_, looks[i]);
  }
  templates_ += "]}}}";
  for (const std::string& p : points) {
    if (!vertices_.empty()) vertices_ += ',';
    vertices_ += p;
  }
  vertex_count_ += static_cast<std::uint32_t>(points.size());
  return place->second;
}

void TemplateTable::append(std::string& out) const {
  out += "{\"templates\":[";
  out += templates_;
  out += "],\"vertices-templates\":[";
  out += vertices_;
  out += "]}";
}

}  // namespace blockrand::outputs
