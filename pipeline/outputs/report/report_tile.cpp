#include "pipeline/outputs/report/report_tile.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

constexpr double kUnitsPerMetre = 10;

/// Appends a ring in whole decimetres; what shrinks to less than a triangle is left out.
bool add_ring(MapFootprints& map, const model::Ring& ring) {
  const std::size_t first = map.corners.size();
  for (const model::Point2& p : ring.points) {
    const MapPoint q{static_cast<std::int32_t>(std::lround(p.x * kUnitsPerMetre)),
                     static_cast<std::int32_t>(std::lround(p.y * kUnitsPerMetre))};
    if (map.corners.size() == first || map.corners.back() != q) map.corners.push_back(q);
  }
  while (map.corners.size() > first + 1 && map.corners.back() == map.corners[first]) map.corners.pop_back();
  if (map.corners.size() < first + 3) {
    map.corners.resize(first);
    return false;
  }
  map.ring_ends.push_back(static_cast<std::uint32_t>(map.corners.size()));
  return true;
}

void add_polygon(MapFootprints& map, const model::Polygon& polygon) {
  if (!add_ring(map, polygon.outer)) return;
  for (const model::Ring& hole : polygon.holes) add_ring(map, hole);
}

/// The position of a value among names, or nothing.
template <std::size_t N>
std::optional<std::size_t> place_in(const std::array<std::string_view, N>& names, std::string_view value) {
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

void count_style(const model::Building& building, StyleCounts& counts) {
  if (!is_classified(building.style)) return;
  // What outputs say, so that a user's correction counts; the attribute may be empty where nothing was resolved.
  const model::Attributes& a = building.attributes;
  const auto style =
      place_in(model::kStyleClassNames, a.style.value).value_or(static_cast<std::size_t>(building.style.style_class()));
  const auto era = place_in(model::kEraNames, a.era.value).value_or(static_cast<std::size_t>(building.style.built()));
  ++counts.classes[style][static_cast<std::size_t>(basis_of(a.style.source, building.style.non_house))];
  ++counts.eras[era][static_cast<std::size_t>(basis_of(a.era.source, false))];
}

}  // namespace

void StyleCounts::add(const StyleCounts& other) {
  const auto sum = [](auto& into, const auto& from) {
    for (std::size_t i = 0; i < into.size(); ++i)
      for (std::size_t k = 0; k < into[i].size(); ++k) into[i][k] += from[i][k];
  };
  sum(classes, other.classes);
  sum(eras, other.eras);
}

ReportTile report_tile(const model::Region& region) {
  ReportTile tile;
  MapFootprints& map = tile.footprints;
  const TagReader tags(region.extract);
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    count_style(building, tile.styles);
    const auto index = static_cast<std::uint32_t>(map.buildings.size());
    MapBuilding b;
    b.osm = building.osm;
    b.first_ring = static_cast<std::uint32_t>(map.ring_ends.size());
    const model::Attributes& a = building.attributes;
    b.storeys = static_cast<float>(a.storeys.value);
    b.storeys_source = a.storeys.source;
    b.height = static_cast<float>(a.height.value);
    b.height_source = a.height.source;
    b.roof_source = a.roof_shape.source;
    double largest = -1;
    for (const model::BuildingPart& part : building.parts) {
      ++map.bodies;
      b.built = true;
      b.lod = std::max(b.lod, static_cast<std::int8_t>(part.lod));
      if (const double area = geometry::area(part.plan); area > largest) {
        largest = area;
        b.roof = part.built_roof;
        b.roof_source = part.attributes.roof_shape.source;
      }
      if (part.osm != building.osm) map.parts.emplace_back(part.osm, index);
    }
    if (!building.outline.empty())
      for (const model::Polygon& p : building.outline) add_polygon(map, p);
    else
      for (const model::BuildingPart& part : building.parts) add_polygon(map, part.plan);
    b.ring_count = static_cast<std::uint32_t>(map.ring_ends.size()) - b.first_ring;
    if (const std::string_view name = tags.name(building.tags); !name.empty()) {
      map.names.emplace_back(name);
      b.name = static_cast<std::uint32_t>(map.names.size());
    }
    map.buildings.push_back(b);
  }
  return tile;
}

}  // namespace blockrand::outputs
