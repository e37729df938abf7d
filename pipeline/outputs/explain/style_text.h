// Why a building has its style, for machines; `blockrand explain` makes words of it. Internal to this folder.
#pragma once

#include "pipeline/outputs/explain/json_text.h"
#include "pipeline/model/building.h"

namespace blockrand::outputs {

/// "style":{...} of a building's line; nothing where nothing was classified.
void append_style(JsonText& json, const model::Building& building);

}  // namespace blockrand::outputs
