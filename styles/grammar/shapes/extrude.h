// Raising faces to solids.
#pragma once

#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

enum class ExtrudeWay : std::uint8_t { face_normal, vertex_normal, world_up, flat_top };

/// extrude(way, distance) (docs/rule_language.md §2.2): the first faces of the result are the old ones as bottoms
/// (turned over), then the tops, then the sides, each beginning with its bottom edge in the old direction. With a
/// negative distance the old faces are the upper side and the solid hangs below them, faces outwards all the same.
void extrude(Shape& shape, ExtrudeWay way, double distance);

}  // namespace blockrand::grammar
