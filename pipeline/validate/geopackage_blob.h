// Geometries as a GeoPackage stores them (OGC 12-128r17, clause 2.1.3): a header, then well-known binary.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/validate/contents.h"

namespace blockrand::validate {

enum class WkbType : std::uint32_t {
  point = 1,
  line_string = 2,
  polygon = 3,
  multi_polygon = 6,
  polygon_z = 1003,
  multi_polygon_z = 1006
};

struct GeoPackageGeometry {
  std::vector<ReadPolygon> polygons;  ///< z is 0 unless the type has it; rings without their repeated last point
  model::Point2 point;                ///< of WkbType::point
  std::vector<model::Point2> line;    ///< of WkbType::line_string
  double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  std::vector<std::string> errors;  ///< what breaks a rule; empty where all is well
};

/// Reads a geometry of the given type and checks: magic and version; flags; the reference system's number; an envelope
/// that is the geometry's, exactly; finite coordinates; rings closed with at least four points, outer ones
/// counter-clockwise, holes clockwise, all with an area (on the map, so not of types with z); lines of two points and more; nothing before or behind. Never throws on account of the
/// bytes; what was read before an error that ends reading is kept.
GeoPackageGeometry read_geopackage_geometry(std::string_view blob, WkbType type, std::int64_t srs_id);

}  // namespace blockrand::validate
