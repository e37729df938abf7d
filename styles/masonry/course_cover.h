// Where a course has room: the free runs of a level band within a wall. Internal.
#pragma once

#include <span>
#include <vector>

#include "styles/masonry/plane.h"

namespace blockrand::masonry {

/// A free run of a band: stones lie between `left` and `right`; cut ones may reach on to `reach_left` and `reach_right`, where the band
/// has less and less room. Between `whole_left` and `whole_right` nothing is cut.
struct FreeRun {
  double left = 0, right = 0, reach_left = 0, reach_right = 0;
  bool cut = false;  ///< part of the band is taken within the reach
};

/// \param outline   of the wall
/// \param blocked   what takes room away
/// \param least     share of the band's height that must be free within a run; cut stones reach to where kLeastReach is
std::vector<FreeRun> free_runs(const Outline& outline, std::span<const Outline> blocked, double from, double to,
                               double low, double high, double least);

}  // namespace blockrand::masonry
