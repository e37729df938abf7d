// The surroundings of a tile as CityGML 2.0.
#pragma once

#include <string>

#include "pipeline/model/region.h"
#include "pipeline/model/surroundings.h"
#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/sink.h"

namespace blockrand::outputs {

/// Writes the city objects of surrounding_objects() in their order, to `sink` in pieces.
///
/// Streets, squares, tracks and car parks have a tran:TrafficArea or tran:AuxiliaryTrafficArea for each kind, material and height
/// of their ground, kerbs among the latter; water has a MultiSurface of LoD1 and a wtr:WaterSurface for each piece of it that
/// hangs together; land a MultiSurface of LoD2. What stands on the ground has LoD3: solids where a body is closed, implicit
/// geometries where an object is placed, of which each shape stands with the first object of the file that has it. Materials
/// are an appearance as in write_citygml(). References to OpenStreetMap stand where the buildings have theirs.
///
/// Of the options name, reference system, heights and attribution count. The same surroundings give the same bytes.
void write_surroundings_gml(const model::Surroundings& surroundings, const model::SurroundingCatalogue& catalogue,
                            model::TileId tile, const CityGmlOptions& options, const Sink& sink);

/// The same as one string.
std::string write_surroundings_gml(const model::Surroundings& surroundings,
                                   const model::SurroundingCatalogue& catalogue, model::TileId tile,
                                   const CityGmlOptions& options);

}  // namespace blockrand::outputs
