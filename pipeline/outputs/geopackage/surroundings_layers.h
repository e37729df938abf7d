// The surroundings of a tile as rows of the GeoPackage: layers that are there where a build makes surroundings.
#pragma once

#include <vector>

#include "pipeline/layer_file/layer_file.h"
#include "pipeline/layer_file/table.h"
#include "pipeline/model/surroundings.h"

namespace blockrand::outputs {

/// The rows of a tile, in the order in which they are given.
struct SurroundingRows {
  layer_file::CellTable ground, bodies, objects;
  bool empty() const { return ground.rows() == 0 && bodies.rows() == 0 && objects.rows() == 0; }
};

/// Prepares the rows of a tile. Pure: the same surroundings give the same rows. Ground is dissolved to its outlines in plan
/// (dissolved_faces.h), bodies keep their faces in space, since many of them have no area from above.
SurroundingRows surrounding_rows(const model::Surroundings& surroundings, const model::SurroundingCatalogue& catalogue);

/// The layers `ground` (MultiPolygon), `surrounding_bodies` (MultiPolygonZ) and `surrounding_objects` (Point), in the order of
/// SurroundingRows. Descriptions are without what is said of all layers.
std::vector<layer_file::LayerSpec> surrounding_layers();

/// How they look in QGIS, one style for each.
std::vector<layer_file::QgisStyle> surrounding_styles();

}  // namespace blockrand::outputs
