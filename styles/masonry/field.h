// The field of a wall: what lies between its dressings. Internal.
#pragma once

#include "styles/masonry/dressings.h"

namespace blockrand::masonry {

/// Courses of bricks or of ashlar.
void lay_courses(const WallToLay& wall, const Masonry& masonry, std::span<const Outline> blocked, LaidWall& out);
/// Cells of rubble or cyclopean stones, with quoins at corners.
void lay_cells(const WallToLay& wall, const Masonry& masonry, std::vector<Outline> blocked, LaidWall& out);

/// m2. Smaller pieces of cut stones are left to the mortar.
double least_piece(const Masonry& masonry);

}  // namespace blockrand::masonry
