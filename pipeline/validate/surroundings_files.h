// Files of what stands around the buildings: whether they can be read and name nothing twice.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/validate/build_record.h"
#include "pipeline/validate/citygml_reader.h"
#include "pipeline/validate/finding.h"
#include "pipeline/validate/finding_log.h"
#include "pipeline/validate/formats.h"
#include "pipeline/validate/tileset_reader.h"

namespace blockrand::validate {

/// What is known of one file.
struct SurroundingsFile {
  std::vector<std::string> ids;       ///< of its city objects, in their order
  std::uint64_t objects = 0;          ///< of a GLB, which gives no ids: rows of its table; of a ground 1
  std::vector<std::string> pictures;  ///< that a ground names, beside it
  std::vector<Finding>
      findings;  ///< FILE_UNREADABLE, CITYGML_RULE, CITYJSON_RULE, GLB_RULE, TILE_BOUNDS; at most a hundred
};

/// Checks that a CityGML file is well-formed, has known city objects, gives gml:ids once, and has what its references and
/// appearances name; that a CityJSON sequence is JSON line by line, has known city objects, gives ids once, and has the vertices,
/// templates and materials that its geometries count; that a GLB can be taken apart, has a property table whose rows are those that
/// its vertices and placed objects name, and lies in its tile; that one of the ground says whose pictures it shows, and names files beside
/// it. Never throws on account of the bytes.
/// \param name  of the file, for findings  \param entry  of a GLB in the tileset; null: where it lies is not checked
SurroundingsFile read_surroundings(Format format, std::string_view bytes, const std::string& name,
                                   const TilesetEntry* entry = nullptr);

struct SurroundingsTotals {
  std::uint64_t files = 0, objects = 0;
};

/// Reads every `sample`-th file of surroundings that build.json lists. They hold no buildings: nothing is counted or compared but
/// their ids, which differ within a format (OBJECT_DOUBLED). Files that are not there are told by check_file_list(). Phase
/// "surroundings" of `progress`.
/// \param schema  of CityGML; may be null  \param tileset  null: there is none
SurroundingsTotals check_surroundings(const std::string& folder, const BuildRecord& record, int sample,
                                      const CityGmlSchema* schema, const Tileset* tileset, int workers,
                                      base::Progress& progress, FindingLog& log);

}  // namespace blockrand::validate
