// Finds what a finished build says about one object.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pipeline/model/osm_id.h"

namespace blockrand::outputs {

/// Reads an object's name as people write it: `w123`, `way/123`, `way 123`, a link to openstreetmap.org, or the id of a
/// body or surface (`w123.w456`, `w123.rest`: the building's). Empty when it is none of them.
std::optional<model::OsmId> parse_object_id(std::string_view text);

/// One object's explanation as JSON.
struct FoundExplanation {
  std::string json;       ///< a line as pipeline/outputs/explain/explanation.h describes; or, for an object that no
                          ///< line explains, its row of report.json with "code", "meaning" and "detail"
  bool in_model = false;  ///< false: a row of report.json
  model::OsmId asked;     ///< may be a part of the building that `json` explains, or its duplicate
  model::OsmId explained;
};

/// \throws base::UsageError  `folder` is no build, or was built without explanations
/// \throws base::InputError  its index is gone. The areas of a build in areas are not looked at.
void check_explained(const std::string& folder);

/// Looks `id` up in explain/index.txt by bisection, then reads one tile's lines; falls back on report.json. A duplicate
/// leads to the object that it duplicates.
/// \param folder  the output folder of a build
/// \returns empty when the build does not know the object
/// \throws base::UsageError  `folder` is no build, or was built without explanations
/// \throws base::InputError  a file of it is damaged
std::optional<FoundExplanation> find_explanation(const std::string& folder, model::OsmId id);

}  // namespace blockrand::outputs
