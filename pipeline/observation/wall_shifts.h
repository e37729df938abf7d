// Walls of an outline, and the outline after each was shifted along its normal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::observation {

/// Rings of points in m, without repeated last point, the building on the left of every edge: outer ones run counter-clockwise.
using Rings = std::vector<std::vector<model::Point2>>;

/// Of the bound: no corner moves farther. Two walls at right angles that move by the whole bound move theirs by 1.41 of it.
inline constexpr double kMostCornerShift = 1.5;
/// Share of a building's area: an outline that changes it by more is another building.
inline constexpr double kMostAreaChange = 0.25;

/// Edges in a straight line, one after the other.
struct Wall {
  std::uint32_t ring = 0;
  std::uint32_t first = 0, edges = 0;  ///< the ring's point where it begins, and how many edges it has
  model::Point2 from, along;           ///< m, where it begins; unit vector, the building on the left
  double length = 0;                   ///< m, from its first point to its last
  std::uint32_t group = 0;             ///< walls of one group have one shift
  model::Point2 normal() const { return {along.y, -along.x}; }  ///< outwards
  model::Point2 at(double distance) const { return {from.x + along.x * distance, from.y + along.y * distance}; }
};

struct Walls {
  std::vector<Wall> walls;      ///< by ring, each in its order
  std::vector<char> movable;    ///< by group: none of its corners is fixed, and it is straight
  std::vector<double> lengths;  ///< m, by group
};

/// The walls of an outline. What is shorter than 0.6 m is a corner, not a wall. Of one group are walls on one line that face the
/// same way, and neighbours that turn by less than 20 degrees: where such meet is no corner.
/// \param fixed  by ring and point: corners that must stay, as neighbours share them; empty: none
Walls find_walls(const Rings& rings, const std::vector<std::vector<char>>& fixed);

/// The outline with its walls shifted. Empty where that cannot be done cleanly: a corner would move by more than `farthest`
/// m, an edge would turn round or lose most of its length, rings would touch, or the area would change by more than kMostAreaChange.
/// Points are rounded to 1 mm; corners between walls that are not shifted stay as they are.
/// \param shifts  m outwards, by group
Rings shifted_outline(const Rings& rings, const Walls& walls, std::span<const double> shifts, double farthest);

}  // namespace blockrand::observation
