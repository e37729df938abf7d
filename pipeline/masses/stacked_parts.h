// Parts of a building that stand on each other, whose heights overlap a little.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pipeline/model/building.h"

namespace blockrand::masses {

/// Vertical extent of a mass, all z above the build's height reference.
struct Levels {
  double bottom = 0, eaves = 0, top = 0;
};

/// A part whose levels gave way to another's.
struct GivenWay {
  std::size_t part = 0, other = 0;  ///< into Building::parts
  double metres = 0;                ///< by which its top went down or its bottom up
};

/// Takes the parts of a building apart that overlap in plan and in height: repair has left their plans together, since
/// one stands on the other by its tags, but storeys of one height meet metres, and slabs are thickened. Of a flat-topped
/// lower part the top comes down to the upper one's bottom; where that would leave less than 1 cm of it, or where it
/// carries a roof, the upper one's bottom goes up to the lower one's top, if half of the upper stays. All else is left:
/// parts that end below the top of the part that they begin in.
/// \param plans   of the masses, by part; empty where nothing is built
/// \param levels  by part
/// \return who gave way, in the order of parts
std::vector<GivenWay> settle_stacks(std::span<const model::Polygon> plans, std::span<Levels> levels);

}  // namespace blockrand::masses
