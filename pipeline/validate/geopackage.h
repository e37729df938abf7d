// The GeoPackage read back with SQLite alone, and whether it keeps the rules of its standard (OGC 12-128r17) and of
// QGIS.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/validate/contents.h"
#include "pipeline/validate/finding_log.h"
#include "pipeline/validate/positions.h"

namespace blockrand::validate {

/// A row of the layer `buildings`. Attributes as in ReadBody.
struct GeoPackageBuilding {
  std::string id;
  std::string state;  ///< "modelled", "represented", "reported"
  int lod = -1;
  std::int64_t parts = 0;
  std::map<std::string, std::string> attributes;
  std::vector<ReadPolygon> footprint;  ///< z is 0
};

/// What the layers say of one tile.
struct GeoPackageTileRows {
  std::vector<GeoPackageBuilding> buildings;
  /// Buildings and bodies in file order; bodies have a flat footprint (z is 0) and no solids. Findings of these rows:
  /// GEOPACKAGE_RULE, SOURCE_WRONG, OFF_GRID.
  Contents contents;
};

/// A row of the layer `reported`: empty where the file says NULL.
struct GeoPackageReportedRow {
  std::string id, kind, state, code, detail, related;
  std::optional<model::Point2> place = std::nullopt;
};

/// A row of the layer `tiles`.
struct GeoPackageTileRow {
  std::string id;   ///< "15/17600/12900"
  std::string uri;  ///< empty where the tile has no GLB
  std::int64_t buildings = 0, parts = 0, bytes = 0;
};

/// One open file. Reading takes one thread at a time: calls from several wait for each other. Nothing is written, not
/// even a lock, and nothing beside the file is read. What is damaged becomes a finding, never an exception.
class GeoPackageReader {
 public:
  /// \param path  of the file
  /// \param name  of it in findings, relative to the build
  GeoPackageReader(const std::string& path, std::string name);
  ~GeoPackageReader();
  GeoPackageReader(const GeoPackageReader&) = delete;
  GeoPackageReader& operator=(const GeoPackageReader&) = delete;

  /// Everything about the file that no single tile can tell: SQLite's own integrity, identification, required tables,
  /// contents, extents, geometry columns, reference system, every geometry, spatial indices row by row, extensions,
  /// descriptions of columns, styles; ids given once; rows of `tiles` and `reported` that are sound and fit the other
  /// layers. FILE_UNREADABLE, GEOPACKAGE_RULE, OBJECT_DOUBLED, COUNTS_DIFFER.
  /// \returns false when the layers cannot be read at all: the other functions then return nothing
  bool check(FindingLog& log);

  /// Number of the layers' reference system ("EPSG:…"), 0 where there is none.
  std::int64_t srs_id();
  /// Tiles of which there are buildings or bodies, in the order of the file.
  std::vector<std::string> tiles();
  /// The rows of one of tiles().
  GeoPackageTileRows rows(const std::string& tile);
  std::vector<GeoPackageReportedRow> reported();
  /// Columns of the layers, by table.
  std::map<std::string, std::set<std::string>, std::less<>> columns();
  std::vector<GeoPackageTileRow> tile_rows();
  /// What the layer `buildings` says of repair.
  RepairsSaid repairs();

  struct State;  ///< internal

 private:
  std::unique_ptr<State> state_;
};

}  // namespace blockrand::validate
