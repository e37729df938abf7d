// Walls that masonry is tried on.
#pragma once

#include <string>
#include <vector>

#include "pipeline/model/polygon.h"
#include "styles/masonry/masonry.h"

namespace blockrand::masonry {

using Outline = std::vector<model::Point2>;

inline constexpr Bond kAllBonds[] = {Bond::stretcher, Bond::header, Bond::english,  Bond::flemish,
                                     Bond::ashlar,    Bond::rubble, Bond::cyclopean};

Outline rectangle(double left, double low, double right, double high);
/// Jambs up to `spring`, then a circle's arc that rises by `rise`.
Outline arched(double left, double low, double right, double spring, double rise);
/// Two arcs of the width as radius.
Outline pointed(double left, double low, double right, double spring);
Outline round_window(model::Point2 middle, double radius);

WallToLay plain_wall(double length, double height);
/// A house front: gable, windows of all forms, a door, corners at both ends.
WallToLay front_wall(std::uint64_t seed = 1);
/// A wall of random length and height with random openings that keep 0.3 m from each other.
WallToLay random_wall(std::uint64_t seed);

model::Polygon polygon_of(const Outline& outline);
/// Of a wall that can be laid.
std::vector<Stone> stones_of(const WallToLay& wall, const Masonry& masonry);
std::string text_of(const Stone& stone);

}  // namespace blockrand::masonry
