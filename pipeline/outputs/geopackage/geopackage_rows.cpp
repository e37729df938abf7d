#include "pipeline/outputs/geopackage/geopackage_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/outputs/geopackage/cell_writer.h"
#include "pipeline/outputs/geopackage/columns.h"
#include "pipeline/outputs/geopackage/wall_segment_rows.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/outputs/style_basis.h"

namespace blockrand::outputs {
namespace {

constexpr std::string_view name(model::OsmType type) {
  return type == model::OsmType::node ? "node" : type == model::OsmType::way ? "way" : "relation";
}

void write_attributes(RowWriter& row, const model::Attributes& attributes) {
  model::for_each_attribute(
      attributes,
      [&](std::string_view, std::string_view, const auto& sourced) {
        row.value(sourced.value);
        row.text(model::name(sourced.source));
        row.real(as_written(sourced.confidence));
      },
      [&](std::string_view, std::string_view) {
        for (int i = 0; i < 3; ++i) row.null();
      });
}

/// style_columns(): `style_p`, `p_*`, `morphology`. Probabilities to a ten-thousandth, as other shares.
void write_style(RowWriter& row, const model::BuildingStyle& style) {
  if (!is_classified(style)) {
    static const std::size_t columns = style_columns().size();
    for (std::size_t i = 0; i < columns; ++i) row.null();
    return;
  }
  const auto share = [](float p) { return std::nearbyint(static_cast<double>(p) * 10000) / 10000; };
  row.real(share(style.style[static_cast<std::size_t>(style.style_class())]));
  for (const float p : style.style) row.real(share(p));
  row.text(model::name(style.quarter()));
}

void write_tags(RowWriter& row, const model::Region& region, model::Range tags) {
  if (!region.extract || tags.count == 0) return row.null();
  append_tags_json(row.begin_text(), *region.extract, tags);
  row.end_text();
}

void write_codes(RowWriter& row, const std::vector<model::IssueCode>& codes) {
  std::string text;
  for (const model::IssueCode code : codes) {
    if (!text.empty()) text += ' ';
    text += model::info(code).text;
  }
  row.text(text);
}

double volume_of(const model::BuildingPart& part) {
  if (part.lod >= 2 && !part.lod2.empty() && part.lod2.closed) return geometry::volume(part.lod2, part.lod2_triangles);
  if (part.lod >= 1 && !part.lod1.empty()) return geometry::volume(part.lod1, part.lod1_triangles);
  return 0;
}

// ---- what a building is as a whole
// ------------------------------------------------------------------------------------

struct Whole {
  std::string_view state;
  int lod = -1;
  model::RoofShape roof = model::RoofShape::flat;
  double area = 0, volume = 0;
  std::vector<model::IssueCode> fallbacks;  ///< each once, in the order met
};

Whole whole_of(const model::Building& building, int asked) {
  Whole w;
  bool own = false, own_stands = false, other_stands = false;
  double largest = -1;
  for (const model::BuildingPart& part : building.parts) {
    const bool stands = part.lod >= std::min(asked, 1);
    const bool is_own = part.osm == building.osm;
    own = own || is_own;
    (is_own ? own_stands : other_stands) |= stands;
    if (stands) w.lod = w.lod < 0 ? part.lod : std::min(w.lod, part.lod);
    const double area = geometry::area(part.plan);
    if (area > largest) {
      largest = area;
      w.roof = part.built_roof;
    }
    if (building.outline.empty()) w.area += area;
    w.volume += volume_of(part);
    for (const model::IssueCode code : part.fallbacks)
      if (std::find(w.fallbacks.begin(), w.fallbacks.end(), code) == w.fallbacks.end()) w.fallbacks.push_back(code);
  }
  for (const model::Polygon& p : building.outline) w.area += geometry::area(p);
  w.state = own_stands ? "modelled" : !own && other_stands ? "represented" : "reported";
  return w;
}

std::string tile_text(model::TileId tile) {
  return std::to_string(tile.level) + '/' + std::to_string(tile.x) + '/' + std::to_string(tile.y);
}

class Builder {
 public:
  Builder(const model::Region& region, int lod)
      : region_(region), lod_(lod), tags_(region.extract), tile_(tile_text(region.tile)) {
    static const std::size_t building_width = building_columns().size(), part_width = part_columns().size();
    std::size_t buildings = 0, parts = 0;
    for (const model::Building& b : region.buildings) {
      if (!b.owned || b.parts.empty()) continue;
      ++buildings;
      parts += b.parts.size();
    }
    rows_.buildings.cells.reserve(buildings * building_width);
    rows_.parts.cells.reserve(parts * part_width);
    static const std::size_t edge_width = wall_segment_columns().size();
    RowWriter building_row(rows_.buildings, building_width), part_row(rows_.parts, part_width),
        edge_row(rows_.wall_segments, edge_width), surface_row(rows_.surfaces, surface_columns().size());
    for (const model::Building& b : region.buildings) {
      if (!b.owned || b.parts.empty()) continue;
      write(building_row, b);
      for (const model::BuildingPart& p : b.parts) {
        write(part_row, b, p);
        write_surfaces(surface_row, b, p);
      }
      append_edges(edge_row, b);
    }
  }
  GeoPackageRows rows() && { return std::move(rows_); }

 private:
  void write(RowWriter& row, const model::Building& b) {
    const Whole whole = whole_of(b, lod_);
    row.text(b.id());
    row.text(name(b.osm.type));
    row.integer(b.osm.number);
    row.text(tile_);
    row.text(whole.state);
    row.integer(whole.lod);
    row.integer(static_cast<std::int64_t>(b.parts.size()));
    row.text(model::name(whole.roof));
    row.real(rounded(whole.area));
    row.real(rounded(whole.volume));
    write_codes(row, whole.fallbacks);
    row.text(b.replaced ? "replaced" : "mapped");
    row.text(b.replaced ? model::text(*b.replaced) : std::string());
    row.text(tags_.name(b.tags));
    const Address address = tags_.address(b.tags);
    row.text(address.empty() ? std::string() : address.line());
    for (const std::string_view field : {address.country, address.city, address.suburb, address.postcode,
                                         address.street.empty() ? address.place : address.street,
                                         address.house_number.empty() ? address.house_name : address.house_number})
      row.text(field);
    write_attributes(row, b.attributes);
    write_shown_colours(row, b.attributes);
    write_style(row, b.style);
    write_situation(row, b);
    write_repair(row, b.repaired);
    write_tags(row, region_, b.tags);
    append_header(row.geometry(), kMultiPolygon, b.outline.empty() ? b.parts.size() : b.outline.size());
    for (const model::Polygon& p : b.outline) append_polygon(row.geometry(), p);
    if (b.outline.empty())
      for (const model::BuildingPart& p : b.parts) append_polygon(row.geometry(), p.plan);
    row.end_row();
  }

  void write(RowWriter& row, const model::Building& b, const model::BuildingPart& p) {
    const std::string building = b.id();
    const bool own_object = p.osm != b.osm;
    row.text(body_id(b, p));
    row.text(building);
    row.text(name(p.osm.type));
    row.integer(p.osm.number);
    row.text(tile_);
    row.integer(p.lod);
    row.text(model::name(p.built_roof));
    row.real(rounded(geometry::area(p.plan)));
    row.real(rounded(volume_of(p)));
    write_codes(row, p.fallbacks);
    row.text(own_object ? tags_.name(p.tags) : std::string_view());
    const Address address = own_object ? tags_.address(p.tags) : Address{};
    row.text(address.empty() ? std::string() : address.line());
    write_attributes(row, p.attributes);
    write_shown_colours(row, p.attributes);
    write_tags(row, region_, own_object ? p.tags : model::Range{});
    append_polygon(row.geometry(), p.plan);
    row.end_row();
  }

  static void write_shown_colours(RowWriter& row, const model::Attributes& a) {
    row.text(model::text(a.shown_wall_colour));
    row.text(model::text(a.shown_roof_colour));
  }

  static std::string body_id(const model::Building& b, const model::BuildingPart& p) {
    return p.id == b.id() && b.parts.size() > 1 ? p.id + ".1" : p.id;
  }

  void write_surfaces(RowWriter& row, const model::Building& b, const model::BuildingPart& p) {
    const bool lod2 = lod_ >= 2 && p.lod >= 2 && !p.lod2.empty();
    if (!lod2 && (lod_ < 1 || p.lod < 1 || p.lod1.empty())) return;
    const model::Solid& solid = lod2 ? p.lod2 : p.lod1;
    using Look = std::tuple<model::SurfaceKind, std::uint8_t, std::uint8_t, std::uint8_t>;
    std::map<Look, std::vector<const model::Face*>> faces;
    for (const model::Face& face : solid.faces)
      faces[{face.kind, face.colour.r, face.colour.g, face.colour.b}].push_back(&face);
    int number = 0;
    for (const auto& [look, those] : faces) {
      row.text(body_id(b, p) + '/' + std::to_string(number++));
      row.text(body_id(b, p));
      row.text(b.id());
      row.text(tile_);
      row.integer(lod2 ? 2 : 1);
      row.text(kClasses[static_cast<std::size_t>(std::get<0>(look))]);
      row.text(model::text(those.front()->colour));
      row.integer(static_cast<std::int64_t>(those.size()));
      append_header(row.geometry(), layer_file::kMultiPolygonZ, those.size());
      for (const model::Face* face : those) layer_file::append_face(row.geometry(), solid, *face);
      row.end_row();
    }
  }
  static constexpr std::string_view kClasses[model::kSurfaceKindCount] = {
      "ground", "wall", "roof", "outer_ceiling", "outer_floor", "closure", "window", "door"};

  const model::Region& region_;
  int lod_;
  TagReader tags_;
  std::string tile_;
  GeoPackageRows rows_;
};

}  // namespace

GeoPackageRows geopackage_rows(const model::Region& region, int lod) { return Builder(region, lod).rows(); }

}  // namespace blockrand::outputs
