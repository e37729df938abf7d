// Brick bonds as joints along a run, in quarter bricks. Internal.
#pragma once

#include <vector>

#include "styles/masonry/masonry.h"

namespace blockrand::masonry {

/// Quarter bricks of a whole run: an even number, of header bond an odd one, at least kShortestRun.
int quarters_of(Bond bond, double length, double quarter);
inline constexpr int kShortestRun = 8;

/// Places of the upright joints between 0 and `quarters`, ascending. Courses of even number begin with a short end (2 quarters) and end
/// with a long one (3 or 4); those of odd number the other way round.
std::vector<int> bond_joints(Bond bond, int quarters, bool odd);

}  // namespace blockrand::masonry
