// What the GeoPackage says of a tile's buildings, prepared away from the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::export_ {

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

/// The rows of a tile.
struct GeoPackageRows {
  CellTable buildings, parts, facade_edges;
};

/// Prepares the rows of the owned buildings of `region` that have at least one part, in their order; of parts and of
/// stretches of the outline in the order of their buildings. Pure: safe on any thread, the same region gives the same rows. This is the expensive half
/// of the work, GeoPackageWriter::add the cheap one.
///
/// Parts have the ids of all other outputs: a part that has its building's id beside other parts becomes "<id>.1". The
/// footprint of a building is its outline, or the plans of its parts where it has none.
/// \param lod  the level of detail that was asked for: decides a building's `state`, as in build.json
GeoPackageRows geopackage_rows(const model::Region& region, int lod);

}  // namespace blockrand::export_
