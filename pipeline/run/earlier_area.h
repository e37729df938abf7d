// What an area is made from beside its objects, and whether one of an earlier build is still what its record says.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipeline/base/pack.h"
#include "pipeline/georef/projection.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {

/// Of the facts of the region those that reach into the area's window: lines of the outline of the data, pinned places.
void pack_facts(base::Packer& key, const TileChoice& area, const georef::Projection& projection);

/// A document; null where there is no such file, discarded where it is none.
nlohmann::ordered_json json_of(const std::string& path);

/// Whether an area's record has that hash, and its files are what it lists: by their size, and where they were touched after the run
/// that wrote them by their content.
/// \param folder        of the area
/// \param build_sha256  of its build.json
/// \param paths         gets the files, as the record names them
/// \throws nlohmann::json::exception  the record has another form
bool area_is_whole(const std::string& folder, const std::string& build_sha256, std::vector<std::string>& paths);

}  // namespace blockrand::run
