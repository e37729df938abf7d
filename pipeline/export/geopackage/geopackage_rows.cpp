#include "pipeline/export/geopackage/geopackage_rows.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "pipeline/export/geopackage/columns.h"
#include "pipeline/export/text.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon.h"

namespace blockrand::export_ {
namespace {

constexpr std::string_view name(model::OsmType type) {
  return type == model::OsmType::node ? "node" : type == model::OsmType::way ? "way" : "relation";
}

/// The double that the shortest text of `value` stands for: 0.6f becomes 0.6, not 0.60000002384.
double as_written(float value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  double out = 0;
  std::from_chars(buffer, end, out);
  return out;
}

/// Areas and volumes are sums; their last bits say nothing.
double rounded(double value) { return std::nearbyint(value * 1000) / 1000; }

// ---- well-known binary (OGC 06-103r4, clause 8), little-endian
// --------------------------------------------------------

static_assert(std::endian::native == std::endian::little, "well-known binary is written as memory holds it");

template <class T>
void append_raw(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

constexpr std::uint32_t kPolygon = 3, kMultiPolygon = 6;

void append_header(std::string& out, std::uint32_t type, std::size_t count) {
  out += '\1';
  append_raw(out, type);
  append_raw(out, static_cast<std::uint32_t>(count));
}

void append_ring(std::string& out, const model::Ring& ring) {
  append_raw(out, static_cast<std::uint32_t>(ring.size() + 1));
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const model::Point2 p = ring.points[i == ring.size() ? 0 : i];
    append_raw(out, p.x);
    append_raw(out, p.y);
  }
}

void append_polygon(std::string& out, const model::Polygon& polygon) {
  if (polygon.outer.points.empty()) return append_header(out, kPolygon, 0);
  append_header(out, kPolygon, 1 + polygon.holes.size());
  append_ring(out, polygon.outer);
  for (const model::Ring& hole : polygon.holes) append_ring(out, hole);
}

// ---- cells
// ------------------------------------------------------------------------------------------------------------

/// Fills a table cell by cell, in the order of its columns.
class RowWriter {
 public:
  RowWriter(CellTable& table, std::size_t width) : table_(table) { table_.width = width; }

  void null() { table_.cells.emplace_back(); }
  void integer(std::int64_t value) {
    Cell& cell = table_.cells.emplace_back();
    cell.kind = Cell::Kind::integer;
    cell.integer = value;
  }
  /// NaN and infinity, which no stage should leave, become NULL.
  void real(double value) {
    Cell& cell = table_.cells.emplace_back();
    if (!std::isfinite(value)) return;
    cell.kind = Cell::Kind::real;
    cell.real = value == 0 ? 0 : value;  // no -0
  }
  /// Empty texts are NULL: nothing is known.
  void text(std::string_view value) {
    if (value.empty()) return null();
    begin_text();
    append_clean(table_.texts, value);
    end_text();
  }
  /// For texts made piece by piece: append to the result, which must hold clean UTF-8, then end_text().
  std::string& begin_text() {
    Cell& cell = table_.cells.emplace_back();
    cell.kind = Cell::Kind::text;
    cell.text = table_.texts.size();
    return table_.texts;
  }
  void end_text() { table_.texts += '\0'; }

  void value(double v) { real(v); }
  void value(const std::string& v) { text(v); }
  void value(model::Colour v) { text(model::text(v)); }
  void value(model::RoofShape v) { text(model::name(v)); }
  void value(model::RoofOrientation v) { text(v == model::RoofOrientation::along ? "along" : "across"); }

  std::string& geometry() { return table_.geometries; }
  void end_row() { table_.geometry_ends.push_back(table_.geometries.size()); }

 private:
  CellTable& table_;
};

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
  if (part.lod >= 2 && !part.lod2.empty()) return geometry::volume(part.lod2, part.lod2_triangles);
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
    RowWriter building_row(rows_.buildings, building_width), part_row(rows_.parts, part_width);
    for (const model::Building& b : region.buildings) {
      if (!b.owned || b.parts.empty()) continue;
      write(building_row, b);
      for (const model::BuildingPart& p : b.parts) write(part_row, b, p);
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
    row.text(tags_.name(b.tags));
    const Address address = tags_.address(b.tags);
    row.text(address.empty() ? std::string() : address.line());
    for (const std::string_view field : {address.country, address.city, address.suburb, address.postcode,
                                         address.street.empty() ? address.place : address.street,
                                         address.house_number.empty() ? address.house_name : address.house_number})
      row.text(field);
    write_attributes(row, b.attributes);
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
    row.text(p.id == building && b.parts.size() > 1 ? building + ".1" : p.id);
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
    write_tags(row, region_, own_object ? p.tags : model::Range{});
    append_polygon(row.geometry(), p.plan);
    row.end_row();
  }

  const model::Region& region_;
  int lod_;
  TagReader tags_;
  std::string tile_;
  GeoPackageRows rows_;
};

}  // namespace

GeoPackageRows geopackage_rows(const model::Region& region, int lod) { return Builder(region, lod).rows(); }

}  // namespace blockrand::export_
