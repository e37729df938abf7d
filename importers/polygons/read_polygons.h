// Polygons with attributes from any vector file that GDAL reads.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::importers::polygons {

/// One feature: its polygons, which may overlap, each with its rings, outer one and holes in any order (even-odd), WGS
/// 84 rounded to 1e-7 degrees, without the first point again at the end.
struct PolygonFeature {
  std::int64_t fid = 0;
  std::vector<std::vector<std::vector<model::Location>>> polygons;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< field and value as text, in the order of the fields
};

/// Which features are read.
struct VectorChoice {
  std::string layer;                                            ///< empty: the only one of the file
  std::vector<std::pair<std::string, std::string>> attributes;  ///< field and the text it must have; all must hold
};

/// Reads the polygons and multipolygons of one layer in the order of their ids. Features of other kinds and empty ones
/// are no error, but a file without any polygon that is chosen is. Coordinates of a layer without a CRS must be
/// degrees.
///
/// \throws base::InputError  naming file, layer and remedy: no such file, a format GDAL does not know, no such layer or
///                           several and none named, no such field (with the nearest), a CRS from which PROJ finds no
///                           way to WGS 84, no polygon chosen, a file that breaks off
std::vector<PolygonFeature> read_polygons(const std::string& path, const VectorChoice& choice = {});

}  // namespace blockrand::importers::polygons
