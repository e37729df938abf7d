// What a caller may know about a reference model beyond what its file says.
#pragma once

#include <optional>
#include <string>

#include "importers/reference/reference_model.h"
#include "pipeline/georef/frames.h"
#include "pipeline/georef/lon_lat.h"

namespace blockrand::importers::reference {

struct ReadOptions {
  /// CityGML, CityJSON: the file's CRS ("EPSG:25833") for files that state none or an unknown one; wins over what the
  /// file states. glTF, 3D Tiles: the projected CRS in metres that the coordinates are wanted in.
  std::string reference_crs;
  /// Where the model is expected, degrees: decides about the axis order where both orders lie in the CRS's area of use.
  std::optional<georef::GeoBox> near;
  /// Overrides what is found out about the axis order.
  AxisOrder axis_order = AxisOrder::automatic;
  /// Where on the WGS 84 ellipsoid a glTF file has its origin: degrees, m above the ellipsoid. There the file is a
  /// local frame, x east, y up, z south. Wins over what the file states; a tileset has a place of its own and does not
  /// ask.
  std::optional<georef::Geodetic> gltf_origin;
};

}  // namespace blockrand::importers::reference
