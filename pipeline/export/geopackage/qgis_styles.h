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

/// buildings: by storeys (default), by built roof, by the source of the storeys, by position; parts: by built roof (default), by
/// level of detail; reported: by code (default); tiles: outlines (default); facade_edges: by kind
/// (default) in the colours of model/edge_colours.h; blocks: by floor area ratio (default), by closure; courtyards: closed
/// or open (default); cells: by built share (default), by storeys.
std::vector<QgisStyle> qgis_styles();

}  // namespace blockrand::export_
