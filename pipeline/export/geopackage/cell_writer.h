// Rows of the GeoPackage put together cell by cell, and geometries as well-known binary. Internal to this folder.
#pragma once

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "pipeline/export/geopackage/geopackage_rows.h"
#include "pipeline/export/text.h"
#include "pipeline/model/building.h"

namespace blockrand::export_ {

/// The double that the shortest text of `value` stands for: 0.6f becomes 0.6, not 0.60000002384.
inline double as_written(float value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  double out = 0;
  std::from_chars(buffer, end, out);
  return out;
}

/// Lengths, areas and volumes are sums; their last bits say nothing.
inline double rounded(double value) { return std::nearbyint(value * 1000) / 1000; }
inline std::optional<double> rounded(const std::optional<double>& value) {
  return value ? std::optional(rounded(*value)) : std::nullopt;
}
/// Directions to a tenth of a degree: footprints know no more.
inline double rounded_degrees(double value) { return std::nearbyint(value * 10) / 10; }
/// The same for directions: in [0, 360).
inline double rounded_direction(double value) {
  const double degrees = rounded_degrees(value);
  return degrees >= 360 ? degrees - 360 : degrees;
}

// ---- well-known binary (OGC 06-103r4, clause 8), little-endian
// --------------------------------------------------------

static_assert(std::endian::native == std::endian::little, "well-known binary is written as memory holds it");

template <class T>
void append_raw(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

inline constexpr std::uint32_t kLineString = 2, kPolygon = 3, kMultiPolygon = 6;

inline void append_header(std::string& out, std::uint32_t type, std::size_t count) {
  out += '\1';
  append_raw(out, type);
  append_raw(out, static_cast<std::uint32_t>(count));
}

inline void append_ring(std::string& out, const model::Ring& ring) {
  append_raw(out, static_cast<std::uint32_t>(ring.size() + 1));
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const model::Point2 p = ring.points[i == ring.size() ? 0 : i];
    append_raw(out, p.x);
    append_raw(out, p.y);
  }
}

inline void append_polygon(std::string& out, const model::Polygon& polygon) {
  if (polygon.outer.points.empty()) return append_header(out, kPolygon, 0);
  append_header(out, kPolygon, 1 + polygon.holes.size());
  append_ring(out, polygon.outer);
  for (const model::Ring& hole : polygon.holes) append_ring(out, hole);
}

inline void append_line(std::string& out, model::Point2 from, model::Point2 to) {
  append_header(out, kLineString, 2);
  for (const double v : {from.x, from.y, to.x, to.y}) append_raw(out, v);
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
  void flag(bool value) { integer(std::int64_t{value}); }
  void real(const std::optional<double>& value) {
    if (value)
      real(*value);
    else
      null();
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

}  // namespace blockrand::export_
