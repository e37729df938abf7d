// Where the walls of an outline went, and what lies between them with them.
#pragma once

#include <span>
#include <vector>

#include "pipeline/footprints/repair/options.h"
#include "pipeline/model/polygon.h"

namespace blockrand::repair {

/// The movement of an outline as a smooth movement of the plane.
///
/// Corners of the two outlines are paired ring by ring in sequence (least sum of squared distances, equal nodes
/// preferred); corners without a partner move as the wall between their neighbours does. A point between the walls
/// moves by the mean of all walls' movements at its nearest points, weighted by the inverse fourth power of the
/// distance (Shepard, A two-dimensional interpolation function, 1968): on a wall it moves as the wall does.
class MovedWalls {
 public:
  MovedWalls(std::span<const model::Polygon> before, std::span<const model::Polygon> after,
             const RepairOptions& options);

  /// False when no corner moved: then every point stays.
  bool any() const { return !walls_.empty(); }

  /// Where a point goes, on the grid. Corners of `before` go to their partners exactly; points on a wall (within
  /// kOnWall) that moved end on the moved wall. Equal points go to equal points.
  model::Point2 operator()(model::Point2 p) const;

  /// m. Nearer points were meant to lie on the wall: two steps of OSM's grid on either side.
  static constexpr double kOnWall = 0.05;

 private:
  struct Wall {
    model::Point2 a, b;    ///< before, m
    model::Point2 da, db;  ///< movement of the ends, m
  };
  struct Segment {
    model::Point2 a, b;
  };
  std::vector<Wall> walls_;       ///< all of `before`; empty when nothing moved
  std::vector<Segment> targets_;  ///< walls of `after`
};

}  // namespace blockrand::repair
