// The QGIS project beside the GeoPackage: its layers in a planner's order, each style of theirs as a layer of its own.
#pragma once

#include <string>

#include "pipeline/geometry/box_index.h"

namespace blockrand::outputs {

struct QgisProject {
  std::string crs;           ///< of all layers: "EPSG:25833"
  std::string crs_name;      ///< "ETRS89 / UTM zone 33N"
  geometry::PlanBox extent;  ///< m in the build CRS, of the buildings; what the map shows first
  std::string about;         ///< source, licence, time and heights of the data, for the project's description
};

/// The project as text (.qgs): the template qgis_project.qgs with styles (qgis_styles.h), CRS and extent filled in. It reads
/// buildings.gpkg in its own folder.
std::string qgis_project(const QgisProject& project);

}  // namespace blockrand::outputs
