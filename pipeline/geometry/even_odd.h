// What a ring encloses that crosses itself.
#pragma once

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// Area in m² of what the ring encloses by the even-odd rule: both loops of a figure eight count, in contrast to
/// signed_area, where they cancel out. Of a ring that runs twice round, once. 0 for rings of fewer than three points.
double even_odd_area(const model::Ring& ring);

}  // namespace blockrand::geometry
