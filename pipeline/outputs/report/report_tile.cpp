#include "pipeline/outputs/report/report_tile.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

/// Appends a ring in whole decimetres; what shrinks to less than a triangle is left out.
bool add_ring(MapFootprints& map, const model::Ring& ring) {
  const std::size_t first = map.corners.size();
  for (const model::Point2& p : ring.points) {
    const MapPoint q{static_cast<std::int32_t>(std::lround(p.x * kMapUnitsPerMetre)),
                     static_cast<std::int32_t>(std::lround(p.y * kMapUnitsPerMetre))};
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

/// The names of a tile, each once: uses and blocks are those of many houses.
class Names {
 public:
  explicit Names(std::vector<std::string>& names) : names_(names) {}
  /// Index + 1; 0 for none.
  std::uint32_t number(std::string_view name) {
    if (name.empty()) return 0;
    const auto [found, added] = numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(names_.size() + 1));
    if (added) names_.emplace_back(name);
    return found->second;
  }

 private:
  std::vector<std::string>& names_;
  std::map<std::string, std::uint32_t> numbers_;
};

Area in_hundredths(double square_metres) { return std::llround(square_metres * 100); }

/// Footprint and floor areas. Each body counts its plan once for every storey between its underside and its eaves.
void measure(const model::Building& building, MapBuilding& b) {
  double standing = 0;
  for (const model::BuildingPart& part : building.parts) {
    if (part.canopy) continue;
    const model::Attributes& a = part.attributes;
    const double area = geometry::area(part.plan);
    const bool on_ground = a.min_height.value <= 0;
    if (on_ground) standing += area;
    const double skipped = on_ground                ? 0.0
                           : part.mapped.min_storey ? static_cast<double>(*part.mapped.min_storey)
                                                    : std::max(0.0, a.min_height.value - a.plinth_height.value) /
                                                          std::max(a.storey_height.value, 1.0);
    const Area floors = in_hundredths(area * std::max(0.0, a.storeys.value - skipped));
    b.floors += floors;
    b.roof_floors += in_hundredths(area * std::max(0.0, a.roof_storeys.value));
    if (!is_stated(a.storeys.source)) b.guessed += floors;
  }
  double outline = 0;
  for (const model::Polygon& p : building.outline) outline += geometry::area(p);
  const bool all_canopies =
      !building.parts.empty() && std::ranges::all_of(building.parts, &model::BuildingPart::canopy);
  // Parts may leave some of the outline to nothing, and stick out of it: the outline is what covers the ground.
  b.footprint = in_hundredths(all_canopies ? 0.0 : outline > 0 ? outline : standing);
}

void classify(const model::Building& building, MapBuilding& b, StyleCounts& counts) {
  if (!is_classified(building.style)) return;
  // What outputs say, so that a user's correction counts; the attribute may be empty where nothing was resolved.
  const model::Attributes& a = building.attributes;
  const auto style =
      place_in(model::kStyleClassNames, a.style.value).value_or(static_cast<std::size_t>(building.style.style_class()));
  const auto era = place_in(model::kEraNames, a.era.value).value_or(static_cast<std::size_t>(building.style.built()));
  b.style = static_cast<std::uint8_t>(style);
  b.era = static_cast<std::uint8_t>(era);
  b.style_source = a.style.source;
  b.era_source = a.era.source;
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

std::optional<MapPoint> middle_of(const MapFootprints& footprints, const MapBuilding& building) {
  if (building.ring_count == 0) return std::nullopt;
  const auto begin = footprints.corners.begin() + footprints.ring_begin(building.first_ring);
  const auto end = footprints.corners.begin() + footprints.ring_ends[building.first_ring + building.ring_count - 1];
  const auto [west, east] = std::minmax_element(begin, end, [](MapPoint a, MapPoint b) { return a.x < b.x; });
  const auto [south, north] = std::minmax_element(begin, end, [](MapPoint a, MapPoint b) { return a.y < b.y; });
  return MapPoint{static_cast<std::int32_t>((std::int64_t{west->x} + east->x) / 2),
                  static_cast<std::int32_t>((std::int64_t{south->y} + north->y) / 2)};
}

ReportTile report_tile(const model::Region& region) {
  ReportTile tile;
  MapFootprints& map = tile.footprints;
  const TagReader tags(region.extract);
  Names names(map.names);
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    const auto index = static_cast<std::uint32_t>(map.buildings.size());
    MapBuilding b;
    b.osm = building.osm;
    classify(building, b, tile.styles);
    measure(building, b);
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
    b.name = names.number(tags.name(building.tags));
    const Address address = tags.address(building.tags);
    // Street and number where both are known: town and postcode are nearly always those of all others.
    const std::string street = address.street_line();
    b.address = names.number(!street.empty() || address.empty() ? street : address.line());
    b.use = names.number(a.use.value);
    b.block = names.number(building.situation.block);
    map.buildings.push_back(b);
  }
  return tile;
}

}  // namespace blockrand::outputs
