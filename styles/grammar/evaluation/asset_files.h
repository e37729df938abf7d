// How large models and pictures are, from their bytes.
#pragma once

#include <optional>
#include <string_view>

#include "styles/grammar/evaluation/functions.h"

namespace blockrand::grammar {

/// The box around the vertices of a Wavefront OBJ file, in its own units (metres). Nothing where there are none.
std::optional<AssetBox> obj_box(std::string_view bytes);

/// Width and height in pixels of a PNG (ISO/IEC 15948, IHDR) or JPEG (ISO/IEC 10918-1, SOF0 to SOF15). Nothing for
/// others.
std::optional<Vector2> picture_size(std::string_view bytes);

}  // namespace blockrand::grammar
