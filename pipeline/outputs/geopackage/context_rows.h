// Blocks, courtyards and district cells as the GeoPackage tells them.
//
// Plain values that the region stage fills: export does not know how they are found. Lengths in metres on the ground,
// areas in square metres; what is empty is NULL in the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/model/osm_id.h"
#include "pipeline/model/polygon.h"
#include "pipeline/outputs/geopackage/geopackage_rows.h"
#include "pipeline/outputs/imagery/seen_outline.h"

namespace blockrand::outputs {

/// The land between streets, railways and water.
struct BlockRow {
  std::string id;          ///< as BuildingSituation::block
  model::Polygon polygon;  ///< build CRS
  double area = 0;
  std::string kind;  ///< "ordinary", "between_carriageways", "between_tracks", "street_space", "water"
  bool cut_by_extract_edge = false, too_large = false;
  std::int64_t buildings = 0;
  std::optional<double> built_share, tagged_share, floor_area_ratio, closure;
  double front_length = 0;  ///< of the street front that `closure` is measured on
  double courtyard_area = 0;
  std::int64_t courtyards = 0;
  std::vector<std::string> streets;  ///< names of the streets around it, or their ids, each once
};

/// Open space that buildings surround.
struct CourtyardRow {
  std::string id;          ///< as BuildingSituation::courtyards
  std::string block;       ///< id; may be empty
  model::Polygon polygon;  ///< build CRS
  double area = 0;
  bool closed = true;
  double opening = 0;                   ///< sum of the gaps that lead out
  std::vector<model::OsmId> buildings;  ///< that surround it, ascending
};

/// A square of the fixed grid.
struct CellRow {
  std::string id;        ///< "c12_-3"
  model::Point2 corner;  ///< m, south-west, build CRS
  double size = 250;     ///< m, side
  std::int64_t buildings = 0;
  double covered_share = 1;  ///< of its area lies within the data; with less than 0.95 it gives no ratios by its area
  std::optional<double> density;  ///< buildings per hectare
  std::optional<double> built_share;
  double tagged_share = 0;
  std::optional<double> storeys_mean, storeys_spread, floor_area_ratio, party_wall_share;
  double dated_share = 0;
  std::optional<double> year_mean, year_spread;
  std::optional<double> footprint_quartile, footprint_median, footprint_upper_quartile;
};

/// An outline that an aerial image shows.
struct FootprintBeforeRow {
  const SeenOutline& seen;
  model::OsmId id;
  std::vector<model::Polygon> polygons;  ///< repaired, before the image moved it
};

/// What looks like a building where none is mapped.
struct UnmappedRow {
  const observation::UnmappedBuilding& candidate;
  const observation::ImageReceipt& image;
};

/// Appends the row to its layer's table.
void append_row(CellTable& table, const UnmappedRow& row);
void append_row(CellTable& table, const FootprintBeforeRow& row);
void append_row(CellTable& table, const BlockRow& row);
void append_row(CellTable& table, const CourtyardRow& row);
void append_row(CellTable& table, const CellRow& row);

}  // namespace blockrand::outputs
