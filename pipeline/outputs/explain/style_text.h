// Why a building has its style, for machines; `blockrand explain` makes words of it. Internal to this folder.
#pragma once

#include "pipeline/model/building.h"
#include "pipeline/outputs/explain/json_text.h"

namespace blockrand::outputs {

/// "style":{...} of a building's line; nothing where nothing was classified.
void append_style(JsonText& json, const model::Building& building);

}  // namespace blockrand::outputs
