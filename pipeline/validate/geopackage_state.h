// What the two halves of GeoPackageReader share: rows tile by tile, and rules of the whole file.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/validate/geopackage.h"
#include "pipeline/validate/geopackage_blob.h"
#include "pipeline/validate/sqlite_file.h"

namespace blockrand::validate {

struct GeoPackageLayer {
  std::string_view table, geometry_type;
  WkbType type;
  bool needs_geometry;
  std::string_view id = "id";  ///< column that names a row in findings
};
inline constexpr GeoPackageLayer kGeoPackageLayers[] = {
    {"buildings", "MULTIPOLYGON", WkbType::multi_polygon, true},
    {"parts", "POLYGON", WkbType::polygon, true},
    {"reported", "POINT", WkbType::point, false},
    {"tiles", "POLYGON", WkbType::polygon, true},
    {"facade_edges", "LINESTRING", WkbType::line_string, true},
    {"blocks", "POLYGON", WkbType::polygon, true},
    {"courtyards", "POLYGON", WkbType::polygon, true},
    {"cells", "POLYGON", WkbType::polygon, true},
    {"surfaces", "MULTIPOLYGON", WkbType::multi_polygon_z, true},
};
/// Layers of builds with surroundings: all of them are there, or none.
inline constexpr GeoPackageLayer kSurroundingLayers[] = {
    {"ground", "MULTIPOLYGON", WkbType::multi_polygon, true, "osm_id"},
    {"surrounding_bodies", "MULTIPOLYGON", WkbType::multi_polygon_z, true, "osm_id"},
    {"surrounding_objects", "POINT", WkbType::point, true, "osm_id"},
};

/// An attribute's column; the others are `<name>_source` and `<name>_confidence`.
struct GeoPackageAttribute {
  std::string name;
  bool number = false;
};
/// In the order of model::for_each_attribute.
const std::vector<GeoPackageAttribute>& geopackage_attributes();

/// Columns that a layer must have besides fid and geom.
std::vector<std::string> geopackage_columns(std::string_view table);

/// m²: areas are written with three decimals; sums of large areas lose digits, 1e-12 of them is what doubles leave.
double area_tolerance(double area);
/// m², holes taken off; outer rings run counter-clockwise.
double area_of(const std::vector<ReadPolygon>& polygons);

/// "w" for "way" and so on; empty for anything else.
std::string_view osm_letter(std::string_view type);

struct GeoPackageReader::State {
  State(const std::string& file_path, std::string file_name)
      : path(file_path), name(std::move(file_name)), db(file_path) {}

  /// First and last fid of a tile's rows.
  struct Span {
    std::int64_t first = 0, last = 0;
  };
  struct TileSpans {
    std::string tile;
    std::map<std::string, Span, std::less<>> layers;  ///< by table
  };
  /// Found once: in the order of the file.
  const std::vector<TileSpans>& spans();
  std::int64_t srs_id();

  std::string path, name;
  std::mutex reading;
  SqliteFile db;
  bool have_spans = false;
  std::vector<TileSpans> tile_spans;
};

/// What repair and context left in the file: columns of buildings, edges of outlines, blocks, courtyards, cells.
/// GEOPACKAGE_RULE, OBJECT_DOUBLED.
void check_context(GeoPackageReader::State& state, FindingLog& log);
/// Columns that these layers must have besides fid and geom; of `buildings` those that come with repair and context.
std::vector<std::string> context_columns(std::string_view table);

}  // namespace blockrand::validate
