#include "pipeline/run/changes_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "pipeline/base/attribution.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/text.h"
#include "pipeline/layer_file/layer_file.h"
#include "pipeline/layer_file/well_known_binary.h"

namespace blockrand::run {
namespace {

using model::Point2;

/// Shapes of a page, at most: more would be a grey cloud, and the layer has all.
constexpr std::size_t kMostShapes = 5000;
constexpr std::size_t kMostPlaces = 12;        ///< drawn, the largest ones
constexpr double kPlaceCell = 0.005;           ///< degrees of latitude, 550 m: what is nearer is one place
constexpr double kLeastPlace = 0.0005;         ///< degrees, 55 m: a single house is not blown up
constexpr double kWidth = 640, kHeight = 480;  ///< of a drawing, pixels
constexpr double kDot = 2;                     ///< pixels: what is smaller has a dot

/// Rings in degrees. An explanation has them flat: longitudes, latitudes in 1e-7 degrees, and the lengths of rings.
std::vector<std::vector<Point2>> rings_of(const std::string& outline) {
  std::vector<std::vector<Point2>> rings;
  const auto j = nlohmann::json::parse(outline, nullptr, false);
  if (!j.is_object() || !j.contains("lon") || !j.contains("lat") || !j.contains("rings")) return rings;
  const auto &lon = j["lon"], &lat = j["lat"];
  if (!lon.is_array() || !lat.is_array() || !j["rings"].is_array() || lon.size() != lat.size()) return rings;
  std::size_t at = 0;
  for (const auto& length : j["rings"]) {
    if (!length.is_number_unsigned()) return {};
    const std::size_t n = length.get<std::size_t>();
    if (n > lon.size() - at) return {};
    std::vector<Point2>& ring = rings.emplace_back();
    for (std::size_t i = 0; i < n; ++i, ++at) {
      if (!lon[at].is_number() || !lat[at].is_number()) return {};
      ring.push_back({lon[at].get<double>() * 1e-7, lat[at].get<double>() * 1e-7});
    }
  }
  return rings;
}

std::string_view state_of(const std::string& id, const BuildChanges& c) {
  if (std::ranges::binary_search(c.added, id)) return "new";
  if (std::ranges::binary_search(c.removed, id)) return "gone";
  return "changed";
}

std::map<std::string, std::vector<const AttributeChange*>> values_by_id(const BuildChanges& c) {
  std::map<std::string, std::vector<const AttributeChange*>> out;
  for (const AttributeChange& a : c.attributes) out[a.id].push_back(&a);
  return out;
}

/// "storeys 4 → 5; height 12.6 → 15.8"
std::string values_text(const std::vector<const AttributeChange*>& values) {
  std::string text;
  for (const AttributeChange* a : values)
    if (a->from != a->to)
      text += (text.empty() ? "" : "; ") + a->name + " " + (a->from.empty() ? "none" : a->from) + " \u2192 " +
              (a->to.empty() ? "none" : a->to);
  return text;
}

void append_outline(std::string& out, const std::string& outline) {
  std::vector<model::Polygon> polygons;
  for (const std::vector<Point2>& ring : rings_of(outline)) {
    if (ring.size() < 3) continue;
    polygons.emplace_back().outer.points = ring;
  }
  if (!polygons.empty()) layer_file::append_multi_polygon(out, polygons);
}

struct Shape {
  std::string id;
  std::string_view state;
  std::vector<std::vector<Point2>> rings;  ///< degrees
};

/// Shapes that lie in one cell of a grid, or in cells side by side, are one place. The largest first.
std::vector<std::vector<const Shape*>> places_of(const std::vector<Shape>& shapes) {
  using Cell = std::pair<std::int64_t, std::int64_t>;
  std::map<Cell, std::vector<const Shape*>> cells;
  for (const Shape& shape : shapes) {
    const Point2 p = shape.rings.front().front();
    const double squeeze = std::max(0.01, base::cos(std::floor(p.y) * base::kRadiansPerDegree));
    cells[{static_cast<std::int64_t>(std::floor(p.x * squeeze / kPlaceCell)),
           static_cast<std::int64_t>(std::floor(p.y / kPlaceCell))}]
        .push_back(&shape);
  }
  std::vector<std::vector<const Shape*>> places;
  while (!cells.empty()) {
    std::vector<const Shape*>& place = places.emplace_back();
    std::vector<Cell> open = {cells.begin()->first};
    while (!open.empty()) {
      const Cell cell = open.back();
      open.pop_back();
      const auto found = cells.find(cell);
      if (found == cells.end()) continue;
      place.insert(place.end(), found->second.begin(), found->second.end());
      cells.erase(found);
      for (std::int64_t x = -1; x <= 1; ++x)
        for (std::int64_t y = -1; y <= 1; ++y) open.push_back({cell.first + x, cell.second + y});
    }
  }
  std::ranges::stable_sort(places, std::greater{}, [](const auto& place) { return place.size(); });
  return places;
}

using base::Values;
using ValueChanges = std::map<std::string, std::vector<const AttributeChange*>>;

/// One place as a figure.
Values drawing(const std::vector<const Shape*>& shapes, const ValueChanges& values) {
  Point2 low{1e9, 1e9}, high{-1e9, -1e9};
  for (const Shape* shape : shapes)
    for (const auto& ring : shape->rings)
      for (const Point2 p : ring) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
  const double squeeze = std::max(0.01, base::cos((low.y + high.y) / 2 * base::kRadiansPerDegree));
  const double width = std::max(kLeastPlace, (high.x - low.x) * squeeze),
               height = std::max(kLeastPlace, high.y - low.y);
  const double scale = std::min(kWidth / width, kHeight / height);
  constexpr double kRim = 10;
  const auto place = [&](Point2 p) {
    return Point2{kRim + (p.x - low.x) * squeeze * scale, kRim + (high.y - p.y) * scale};
  };
  Values out;
  out.set("width", fmt::format("{:.0f}", 2 * kRim + width * scale));
  out.set("height", fmt::format("{:.0f}", 2 * kRim + height * scale));
  for (const Shape* shape : shapes) {
    std::string path;
    Point2 least{1e9, 1e9}, most{-1e9, -1e9};
    for (const auto& ring : shape->rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 p = place(ring[i]);
        least = {std::min(least.x, p.x), std::min(least.y, p.y)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y)};
        path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", p.x, p.y);
      }
      path += "Z";
    }
    std::string title = shape->id + ": " + std::string(shape->state);
    if (const auto found = values.find(shape->id); found != values.end())
      if (const std::string text = values_text(found->second); !text.empty()) title += ", " + text;
    Values drawn;
    drawn.set("state", shape->state).set("title", title).set("path", false).set("dot", false);
    if (std::max(most.x - least.x, most.y - least.y) < 2 * kDot) {
      Values dot;
      dot.set("x", fmt::format("{:.1f}", (least.x + most.x) / 2))
          .set("y", fmt::format("{:.1f}", (least.y + most.y) / 2));
      drawn.add("dot", std::move(dot.set("radius", fmt::format("{:g}", kDot))));
    } else {
      drawn.set("path", std::move(path));
    }
    out.add("shapes", std::move(drawn));
  }
  out.set("caption",
          fmt::format("{} {} around {:.5f}, {:.5f} (latitude, longitude)", shapes.size(),
                      shapes.size() == 1 ? "building" : "buildings", (low.y + high.y) / 2, (low.x + high.x) / 2));
  return out;
}

}  // namespace

std::optional<Values> changes_map(const BuildChanges& c) {
  std::vector<Shape> shapes;
  for (const auto& [id, outline] : c.footprints) {
    if (shapes.size() == kMostShapes) break;
    Shape shape{id, state_of(id, c), rings_of(outline)};
    if (!shape.rings.empty()) shapes.push_back(std::move(shape));
  }
  if (shapes.empty()) return std::nullopt;
  const auto values = values_by_id(c);
  const std::vector<std::vector<const Shape*>> places = places_of(shapes);
  Values out;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < std::min(places.size(), kMostPlaces); ++i) {
    out.add("places", drawing(places[i], values));
    drawn += places[i].size();
  }
  out.set("elsewhere", c.footprints.size() > drawn ? base::with_thousands(c.footprints.size() - drawn) : std::string());
  return out;
}

void write_changes_layers(const BuildChanges& c, const std::string& path) {
  using layer_file::Column;
  using layer_file::ColumnKind;
  const std::vector<Column> buildings = {{"id", ColumnKind::text, "", "OSM id"},
                                         {"state", ColumnKind::text, "", "new, gone or changed"},
                                         {"footprint", ColumnKind::integer, "", "1 where the footprint is another one"},
                                         {"area_before", ColumnKind::real, "m²", "Area of the footprint before"},
                                         {"area_after", ColumnKind::real, "m²", "Area of the footprint now"},
                                         {"changed_values", ColumnKind::text, "", "Attributes with another value"}};
  const std::vector<Column> values = {{"id", ColumnKind::text, "", "OSM id of the building"},
                                      {"attribute", ColumnKind::text, "", "Name of the attribute"},
                                      {"from_value", ColumnKind::text, "", "Value before"},
                                      {"to_value", ColumnKind::text, "", "Value now"},
                                      {"from_source", ColumnKind::text, "", "Where it came from"},
                                      {"to_source", ColumnKind::text, "", "Where it comes from"},
                                      {"why", ColumnKind::text, "", "The reason in words"}};
  std::map<std::string, const OutlineChange*> outlines;
  for (const OutlineChange& o : c.outlines) outlines[o.id] = &o;
  const auto by_id = values_by_id(c);
  layer_file::CellTable building_table, value_table;
  layer_file::RowWriter building(building_table, buildings.size()), value(value_table, values.size());
  for (const auto& [id, outline] : c.footprints) {
    building.text(id);
    building.text(state_of(id, c));
    const auto other = outlines.find(id);
    building.flag(other != outlines.end());
    building.real(other == outlines.end() ? std::nullopt : std::optional(other->second->area_before));
    building.real(other == outlines.end() ? std::nullopt : std::optional(other->second->area_after));
    const auto its = by_id.find(id);
    building.text(its == by_id.end() ? "" : values_text(its->second));
    append_outline(building.geometry(), outline);
    building.end_row();
    if (its == by_id.end()) continue;
    for (const AttributeChange* a : its->second) {
      for (const std::string* text : {&a->id, &a->name, &a->from, &a->to, &a->from_source, &a->to_source, &a->why})
        value.text(*text);
      append_outline(value.geometry(), outline);
      value.end_row();
    }
  }
  const std::string source = std::string(". ") + base::kAttribution;
  std::error_code error;
  std::filesystem::remove(path, error);
  layer_file::LayerFile file(path, {"EPSG:4326", ""},
                             {{"buildings", layer_file::GeometryKind::multi_polygon, buildings,
                               "Buildings that differ from the build before" + source},
                              {"values", layer_file::GeometryKind::multi_polygon, values,
                               "Values that differ from the build before" + source}});
  file.put(0, building_table);
  file.put(1, value_table);
  file.close();
}

}  // namespace blockrand::run
