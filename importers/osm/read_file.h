// An open file becomes an extract. Internal to this folder.
#pragma once

#include <string>

#include "importers/osm/osm_file.h"
#include "importers/osm/read_extract.h"

namespace blockrand::importers::osm {

/// \param name  of the extract, for people
/// \throws base::InputError
model::Extract read_file(OsmFile& file, const std::string& name, const ReadOptions& options);

}  // namespace blockrand::importers::osm
