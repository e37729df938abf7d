// The build as a GeoPackage (OGC 12-128r17) that opens coloured in QGIS.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/model/region.h"
#include "pipeline/outputs/geopackage/context_rows.h"
#include "pipeline/outputs/geopackage/geopackage_rows.h"
#include "pipeline/outputs/geopackage/surroundings_layers.h"

namespace blockrand::outputs {

struct GeoPackageOptions {
  std::string crs;               ///< of all layers: "EPSG:25833"
  std::string data_time;         ///< newest time of the data, ISO 8601 in UTC; stands for every date in the file
  std::string height_reference;  ///< in words, for the layers' descriptions
  std::string attribution;       ///< source and licence of the data, for the layers' descriptions
  bool images = false;           ///< the layers footprint_before and unmapped are there
  bool surroundings = false;     ///< the layers of surroundings_layers.h are there, behind all others
};

/// An object of the extract that is not modelled itself.
struct GeoPackageReported {
  model::OsmId id;
  model::ObjectKind kind = model::ObjectKind::building;
  model::ObjectState state = model::ObjectState::reported;
  model::IssueCode code = model::IssueCode::none;
  std::string detail;                   ///< may be empty
  std::optional<model::OsmId> related;  ///< of whom it is a duplicate, or who represents it
  std::optional<model::Point2> place;   ///< in the build CRS, where one is known
};

/// A tile with content.
struct GeoPackageTile {
  model::TileId id;
  std::string uri;  ///< of its GLB, relative to the build; empty where there is none
  std::uint64_t buildings = 0, parts = 0;
  std::uint64_t bytes = 0;             ///< of the GLB
  std::vector<model::Point2> outline;  ///< in the build CRS, counter-clockwise, first point not repeated
};

/// Writes one file with the layers `buildings` (MultiPolygon), `parts` (Polygon), `reported` (Point, NULL where no
/// place is known), `tiles` (Polygon), `facade_edges` (LineString), `blocks`, `courtyards` and `cells` (Polygon), `surfaces` (MultiPolygonZ); columns in columns.h, their meaning and unit in the file's gpkg_data_columns.
/// With images also `footprint_before` (MultiPolygon): outlines that an image shows, as they stood before it, with the receipt;
/// and `unmapped` (Polygon): what looks like a building where none is mapped.
/// With surroundings also surrounding_layers().
/// The table `layer_styles` holds QGIS styles, one default for each layer.
///
/// The same calls give the same bytes: the file holds no clock and no UUID. One thread at a time, any thread; no GDAL
/// setting of the process is changed and GDAL prints nothing. Rows reach the disk as they come; memory is SQLite's page
/// cache (32 MB) and 40 bytes for each row of the spatial index.
///
/// Every function throws base::OutputError that names path and remedy when the file cannot be written. The file is
/// complete after close() only; a writer that is destroyed without it removes the file.
class GeoPackageWriter {
 public:
  /// \param path  must not exist; its folder must
  GeoPackageWriter(std::string path, GeoPackageOptions options);
  ~GeoPackageWriter();
  GeoPackageWriter(const GeoPackageWriter&) = delete;
  GeoPackageWriter& operator=(const GeoPackageWriter&) = delete;

  /// Appends a tile's buildings, bodies and wall segments of outlines.
  void add(const GeoPackageRows& rows);
  /// Appends what stands around them; options.surroundings says that there is any.
  void add(const SurroundingRows& rows);
  void add_reported(const GeoPackageReported& object);
  void add_tile(const GeoPackageTile& tile);
  /// Rows stand in the file in the order of these calls.
  void add_block(const BlockRow& block);
  void add_courtyard(const CourtyardRow& courtyard);
  void add_cell(const CellRow& cell);
  void add_footprint_before(const FootprintBeforeRow& row);
  void add_unmapped(const UnmappedRow& row);

  /// Makes the spatial indices and ends the file; no journal stays beside it.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blockrand::outputs
