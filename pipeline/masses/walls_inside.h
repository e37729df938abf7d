// Points of walls that rounding has put before their wall.
#pragma once

#include "pipeline/model/solid.h"

namespace blockrand::masses {

/// Moves points of outer walls (tops of gables, breaks of roofs) that lie before the plane over their wall's foot to the
/// nearest grid point in it or behind: by at most 0.002 m in plan. So two bodies whose plans share a wall share no room
/// above it. Only points within rounding of that plane move; walls without a straight foot at the solid's lowest level
/// are left alone. Nothing is checked: faces around a moved point may be less plane than before.
/// \return whether any point moved
bool keep_walls_inside(model::Solid& solid);

}  // namespace blockrand::masses
