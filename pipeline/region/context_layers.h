// Blocks, courtyards and district cells as rows of the GeoPackage.
#pragma once

#include <optional>

#include "pipeline/export/geopackage/geopackage_writer.h"
#include "pipeline/model/region.h"
#include "pipeline/region/context_extract.h"
#include "pipeline/region/footprints.h"
#include "pipeline/region/repair_extract.h"
#include "pipeline/region/shard.h"

namespace blockrand::region {

/// Writes the layers `blocks`, `courtyards` and `cells`: all of the extract's, or, for a tile that is built alone, those
/// in which or at which one of its buildings stands (what lies beyond was read in part only).
void write_context_layers(export_::GeoPackageWriter& out, const ContextExtract& context, const RepairedExtract& repaired,
                          std::span<const Shard> shards, const std::optional<model::TileId>& tile);

}  // namespace blockrand::region
