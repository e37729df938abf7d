// The records in explain/ read back.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/finding_log.h"
#include "pipeline/validate/report_check.h"

namespace blockrand::validate {

/// explain/index.txt: by tile, the objects that a line speaks of, each with the building whose line it is.
using ExplanationIndex = std::map<std::string, std::vector<std::pair<std::string, std::string>>>;

/// EXPLANATION_WRONG for lines that are no entry or an object that stands twice.
ExplanationIndex read_explanation_index(std::string_view text, FindingLog& log);

/// A line of explain/places.tsv, texts as they stand there.
struct PlaceRow {
  double lon = 0, lat = 0, top = 0;  ///< degrees; m
  std::string addresses, name;
};
/// By tile and building.
using ExplainedPlaces = std::map<std::string, std::map<std::string, PlaceRow>>;

/// EXPLANATION_WRONG for lines without the seven fields, out of the order of ids, or of a building that stands twice.
ExplainedPlaces read_places(std::string_view text, FindingLog& log);

/// The records of a tile: each line a JSON object about a building of this tile; each building of the model has one,
/// with its bodies and the values that the other formats have; files it names are listed; the index leads to it.
/// \param model  what another format holds of the tile; null: not compared
/// \param lean   that format is lean CityGML: elements in openings are not there
/// \param entries  of the index, of this tile
/// \param places  the tile's lines of places.tsv, which say the same as its records; null: the build has none
/// \return the number of records
std::size_t check_explanations(std::string_view lines, const std::string& file, const std::string& tile,
                               const Contents* model, bool lean,
                               const std::vector<std::pair<std::string, std::string>>& entries,
                               const std::map<std::string, PlaceRow>* places, const BuildRecord& record,
                               std::vector<Finding>& findings);

}  // namespace blockrand::validate
