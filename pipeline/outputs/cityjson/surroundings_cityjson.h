// The surroundings of a tile as a CityJSON 2.0 text sequence.
#pragma once

#include <string>

#include "pipeline/model/region.h"
#include "pipeline/model/surroundings.h"
#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/outputs/sink.h"

namespace blockrand::outputs {

/// Writes the city objects of surrounding_objects() in their order, one CityJSONFeature a line behind a first line with transform,
/// metadata and the shapes of placed objects as geometry templates. Ids are those of CityGML. Traffic areas, kerbs and water are
/// semantic surfaces of one MultiSurface of LoD 2; bodies and placed objects have LoD 3. Vertices, materials and scale as in
/// write_cityjson_sequence(). The same surroundings give the same bytes.
void write_surroundings_cityjson(const model::Surroundings& surroundings, const model::SurroundingCatalogue& catalogue,
                                 model::TileId tile, const CityJsonOptions& options, const Sink& sink);

/// The same as one string.
std::string write_surroundings_cityjson(const model::Surroundings& surroundings,
                                        const model::SurroundingCatalogue& catalogue, model::TileId tile,
                                        const CityJsonOptions& options);

}  // namespace blockrand::outputs
