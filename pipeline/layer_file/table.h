// Tables of a GeoPackage in memory: columns and rows, put together cell by cell.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/markup.h"
#include "pipeline/base/pack.h"

namespace blockrand::layer_file {

enum class ColumnKind : std::uint8_t { integer, real, text };

struct Column {
  std::string name;
  ColumnKind kind = ColumnKind::text;
  std::string unit;         ///< "m", "m²", "degree"; empty for counts and texts
  std::string description;  ///< one sentence, without the unit
};

/// One value of a row.
struct Cell {
  enum class Kind : std::uint8_t { null, integer, real, text };
  Kind kind = Kind::null;
  union {
    std::int64_t integer = 0;
    double real;
    std::size_t text;  ///< where the text starts in CellTable::texts
  };
};

/// Rows of one layer, flat: `width` cells each. Texts are clean UTF-8 and end with a zero byte; geometries are
/// well-known binary, little-endian.
}  // namespace blockrand::layer_file

template <>
struct blockrand::base::PackTraits<blockrand::layer_file::Cell> {
  using Cell = layer_file::Cell;
  static void pack(Packer& out, const Cell& cell) { out << cell.kind << cell.integer; }
  static void unpack(Unpacker& in, Cell& cell) {
    in >> cell.kind >> cell.integer;
    if (cell.kind > Cell::Kind::text) throw UnpackError();
  }
};

namespace blockrand::layer_file {

struct CellTable {
  std::size_t width = 0;
  std::vector<Cell> cells;
  std::string texts;
  std::string geometries;
  std::vector<std::size_t> geometry_ends;  ///< per row: where its geometry ends in `geometries`

  std::size_t rows() const { return geometry_ends.size(); }
  std::string_view geometry(std::size_t row) const {
    const std::size_t first = row == 0 ? 0 : geometry_ends[row - 1];
    return std::string_view(geometries).substr(first, geometry_ends[row] - first);
  }
};

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
    base::append_clean(table_.texts, value);
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

  std::string& geometry() { return table_.geometries; }
  void end_row() { table_.geometry_ends.push_back(table_.geometries.size()); }

 private:
  CellTable& table_;
};

}  // namespace blockrand::layer_file
