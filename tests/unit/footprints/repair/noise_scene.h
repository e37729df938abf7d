// The noise experiment: true footprints, copies of them with the errors of mapping, and how much of the truth comes back.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_row.h"

namespace blockrand::repair::test {

/// Footprints in the order of Row::buildings.
using Footprints = std::vector<std::vector<model::Polygon>>;

/// Rows, bent rows and perimeter blocks of houses with different depths, wings, corner houses, chamfers, oblique ends and
/// alleys of 0.8 to 3 m; every block turned by an angle of its own. Corners of a neighbour in the middle of a wall are
/// vertices of the wall in some houses, as in real data.
Footprints true_houses(std::uint32_t seed, int blocks);

/// Every vertex of every footprint moved uniformly in a disc of `radius` metres, independently for each footprint, and
/// rounded to the grid. A footprint that is not simple afterwards is drawn again. Every vertex gets a node of its own.
Footprints with_noise(const Footprints& truth, double radius, std::uint32_t seed);

TerraceRow row_of(const Footprints& footprints);

/// The footprints cut into rows of those nearer than `reach` metres to each other (by bounding boxes), repaired apart.
std::vector<std::vector<std::size_t>> rows_of(const Footprints& footprints, double reach);

struct Score {
  int walls = 0,
      walls_recovered = 0;  ///< true shared walls of at least 1 m; with the same points for 90 % of the length
  int alleys = 0, alleys_closed = 0;  ///< pairs that face each other across 0.8 to 3 m; with a common edge afterwards
  int alleys_touching = 0;            ///< with a common point afterwards
  int right = 0, right_restored = 0;  ///< true right angles with legs of at least 1 m; right to 0.1 degrees
  int oblique = 0,
      oblique_squared = 0;  ///< true corners more than 5 degrees off right, legs of at least 8 m; right to 0.2
  double error_before = 0, error_after = 0;  ///< m, mean distance of vertices from the truth
  double largest_shift = 0;                  ///< m, of RepairRecord
  double overlap = 0;                        ///< m2, left between neighbours
  int invalid = 0;                           ///< polygons that are not strictly simple
  std::string text() const;
};

/// Compares a repaired row with the truth. `noisy` is what repair was given.
Score score(const Footprints& truth, const Footprints& noisy, const TerraceRow& repaired);

}  // namespace blockrand::repair::test
