// Which files of a build belong to which tile.
#pragma once

#include <map>
#include <string>

#include "pipeline/validate/build_record.h"
#include "pipeline/validate/finding_log.h"
#include "pipeline/validate/tile_check.h"

namespace blockrand::validate {

/// By tile ("15_17600_12900"), as build.json lists them; of a GLB in pieces the first stands for the whole.
/// \param log  TILE_MISSING: a tile with a GLB and with pieces of it
std::map<std::string, TileFiles> files_by_tile(const BuildRecord& record, FindingLog& log);

}  // namespace blockrand::validate
