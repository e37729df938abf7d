// The QGIS project beside the GeoPackage: its layers in a planner's order, each style of theirs as a layer of its own.
#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "pipeline/model/point.h"

namespace blockrand::outputs {

/// A rectangle along the axes of the build CRS; empty until a point is added.
struct PlanBox {
  double west = std::numeric_limits<double>::infinity(), south = west, east = -west, north = -west;  ///< m
  bool empty() const { return west > east; }
  void add(const model::Point2& p) {
    west = std::min(west, p.x), east = std::max(east, p.x);
    south = std::min(south, p.y), north = std::max(north, p.y);
  }
  void join(const PlanBox& other) {
    west = std::min(west, other.west), east = std::max(east, other.east);
    south = std::min(south, other.south), north = std::max(north, other.north);
  }
};

struct QgisProject {
  std::string crs;       ///< of all layers: "EPSG:25833"
  std::string crs_name;  ///< "ETRS89 / UTM zone 33N"
  PlanBox extent;        ///< of the buildings; what the map shows first
  std::string about;     ///< source, licence, time and heights of the data, for the project's description
};

/// The project as text (.qgs): the template qgis_project.qgs with styles (qgis_styles.h), CRS and extent filled in. It reads
/// buildings.gpkg in its own folder.
std::string qgis_project(const QgisProject& project);

}  // namespace blockrand::outputs
