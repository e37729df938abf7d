// Blocks, courtyards and district cells as rows of the GeoPackage.
#pragma once

#include <optional>

#include "pipeline/context/context_extract.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "pipeline/outputs/geopackage/geopackage_writer.h"

namespace blockrand::outputs {

/// Writes the layers `blocks`, `courtyards` and `cells`: all of the extract's, or, for a tile that is built alone, those
/// in which or at which one of its buildings stands (what lies beyond was read in part only), and blocks without buildings whose
/// first corner lies in it.
void write_context_layers(outputs::GeoPackageWriter& out, const context::ContextExtract& context,
                          const footprints::RepairedExtract& repaired, std::span<const footprints::Shard> shards,
                          const std::optional<model::TileId>& tile, const georef::Projection& projection);

/// Writes the layers `footprint_before`: of all buildings that an image shows, or of those of one tile; and `unmapped`.
void write_image_layer(GeoPackageWriter& out, const observation::ImageryObservations& seen,
                       const footprints::RepairedExtract& repaired, std::span<const footprints::Shard> shards,
                       const std::optional<model::TileId>& tile);

}  // namespace blockrand::outputs
