// What repair did to an outline and what context found around it: in words and for machines. Internal to this folder.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/outputs/explain/explanation.h"
#include "pipeline/outputs/explain/json_text.h"

namespace blockrand::outputs {

/// "1 wall", "3 walls".
std::string counted(std::size_t n, std::string_view noun);
/// "a", "a and b", "a, b and 3 more".
std::string listed(const std::vector<std::string>& names, std::size_t most);

/// "12 of 14 corners moved by 0.08 m on average, 0.31 m at most, to share 3 walls with w1 and w2 and to make corners
/// right; area 312.4 -> 313.0 m2". Empty where repair left no record.
std::string moved_text(const model::Building& building);

/// "corner house; fronts on Kastanienallee (24.1 m, looks SW) and Oderberger Strasse (14.0 m, looks W); ...".
/// \param courtyard  what is known of a courtyard; may be empty
std::string situation_text(const model::Building& building, const CourtyardLookup& courtyard);

/// "repair":{...}, "situation":{...} and "edges":[...] of a building's line; nothing where the stage left nothing.
void append_repair(JsonText& json, const model::Building& building);
/// "imagery":{...}: the receipt of an aerial image.
void append_imagery(JsonText& json, const SeenOutline& seen);
void append_situation(JsonText& json, const model::Building& building);
/// \param extract  where points have their streets; may be null
void append_edges(JsonText& json, const model::Building& building, const model::Extract* extract);

}  // namespace blockrand::outputs
