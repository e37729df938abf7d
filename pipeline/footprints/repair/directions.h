// What the walls of a row say about its dominant directions and about how exactly it was mapped.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/footprints/repair/terrace_lines.h"
#include "pipeline/footprints/repair/terrace_row.h"

namespace blockrand::repair {

struct TerraceDirections {
  TerraceLines row;
  std::vector<model::Point2> frames;      ///< unit vectors, x > 0, y >= 0
  std::vector<std::uint32_t> main_frame;  ///< parallel to `row.buildings`; kNoFrame where one has none
  double noise = 0;                       ///< m, standard deviation of one footprint's corner in each coordinate
};

/// Reads the directions of the footprints that have the rings `rings` (indices into graph.rings, ascending): a
/// connected row. Nothing is moved.
///
/// Frame of a building: the direction, modulo a quarter turn, that most of its walls' length agrees with (the mode,
/// then a redescending M-estimate of it; Huber & Ronchetti, Robust Statistics, 2009, ch. 4). A wing at another angle
/// has a frame of its own. Frames of buildings that share a wall are merged, the most alike first, while they differ by
/// no more than the noise of mapping explains: straight rows get one, bent rows keep theirs. Noise: fit_noise, from
/// three starts. A wall gets a frame's direction when that is likelier than that it has one of its own (odds_of_frame),
/// its sideways deviation is within kDeviations times the noise, it is not off by more than kLargestTurn, and, from 8 m
/// of length on, not by 5 degrees less its own uncertainty. Curves and cheeks of bays get none. The result does not
/// depend on the order of buildings or where rings start, and turns with the row.
TerraceDirections find_directions(const TerraceGraph& graph, std::span<const std::uint32_t> rings);

/// Unit vector of a frame's axis, or of the one across it.
inline model::Point2 axis_of(model::Point2 frame, bool across) {
  return across ? model::Point2{-frame.y, frame.x} : frame;
}

}  // namespace blockrand::repair
