// A GeoPackage (OGC 12-128r17) of any layers: the one place that writes one.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/layer_file/table.h"

namespace blockrand::layer_file {

enum class GeometryKind : std::uint8_t { point, line, polygon, multi_polygon, multi_polygon_z };

struct LayerSpec {
  std::string table;
  GeometryKind geometry = GeometryKind::polygon;
  std::vector<Column> columns;  ///< without `fid` and `geom`
  std::string description;
};

/// A row of the table layer_styles.
struct QgisStyle {
  std::string layer;  ///< table it belongs to
  std::string name;
  std::string description;
  std::string qml;          ///< QGIS layer style of QGIS 3.22, read by every later version
  bool is_default = false;  ///< one per layer
};

struct FileOptions {
  std::string crs;        ///< of all layers: "EPSG:25833"
  std::string data_time;  ///< ISO 8601 in UTC; stands for every date in the file; empty: the epoch
};

/// Writes one file. Columns have their meaning and unit in the file's gpkg_data_columns; the table `layer_styles` holds
/// the QGIS styles.
///
/// The same calls give the same bytes: the file holds no clock and no UUID. One thread at a time, any thread; no GDAL
/// setting of the process is changed and GDAL prints nothing. Rows reach the disk as they come; memory is SQLite's page
/// cache (32 MB) and 40 bytes for each row of the spatial index.
///
/// Every function throws base::OutputError that names path and remedy when the file cannot be written. The file is
/// complete after close() only; a writer that is destroyed without it removes the file.
class LayerFile {
 public:
  /// \param path    must not exist; its folder must
  /// \param styles  without any there is no table of styles
  LayerFile(std::string path, FileOptions options, const std::vector<LayerSpec>& layers,
            const std::vector<QgisStyle>& styles = {});
  ~LayerFile();
  LayerFile(const LayerFile&) = delete;
  LayerFile& operator=(const LayerFile&) = delete;

  /// Appends rows to a layer. An empty geometry is NULL.
  /// \param layer  index into the list of layers
  void put(std::size_t layer, const CellTable& rows);

  /// Makes the spatial indices and ends the file; no journal stays beside it.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blockrand::layer_file
