// The colour of panes of which neither rule nor building says one.
#pragma once

#include "pipeline/model/colour.h"

namespace blockrand::model {

/// Of glass in windows and doors, as the data have it. GLBs with textures show such panes as it is seen in streets
/// (pipeline/outputs/gltf/panes.h).
inline constexpr Colour kUsualGlass{0x51, 0x62, 0x6E};

}  // namespace blockrand::model
