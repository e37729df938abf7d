// How the GeoPackage's layers look in QGIS.
#pragma once

#include <string>
#include <vector>

namespace blockrand::export_ {

/// A row of the table layer_styles.
struct QgisStyle {
  std::string layer;  ///< table it belongs to
  std::string name;
  std::string description;
  std::string qml;          ///< QGIS layer style of QGIS 3.22, read by every later version
  bool is_default = false;  ///< one per layer
};

/// buildings: by storeys (default), by built roof, by the source of the storeys; parts: by built roof (default), by
/// level of detail; reported: by code (default); tiles: outlines (default).
std::vector<QgisStyle> qgis_styles();

}  // namespace blockrand::export_
