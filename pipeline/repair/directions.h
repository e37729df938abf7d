// What the walls of a row say about its dominant directions and about how exactly it was mapped.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/repair/options.h"
#include "pipeline/repair/row.h"

namespace blockrand::repair {

inline constexpr std::uint32_t kNoFrame = 0xffffffff;

/// An edge of a footprint before sharing: the run of a ring's edges that have one `RowRing::wall`.
struct RingWall {
  std::uint32_t ring = 0;   ///< index into RowGraph::rings
  std::uint32_t first = 0;  ///< its first edge
  std::uint32_t count = 0;  ///< edges
  std::uint32_t line = 0;   ///< index into RowDirections::lines
};

/// A wall as it stands: all ring walls that share an edge, of however many footprints.
struct WallLine {
  std::vector<std::uint32_t> corners;    ///< along it, each once
  std::vector<std::uint32_t> buildings;  ///< whose wall it is, ascending; indices into RowDirections::buildings
  model::Point2 along{1, 0};             ///< unit vector of the line fitted through what is said of its corners
  double length = 0;                     ///< m
  double weight = 0;                     ///< m². Noise of s m at a corner turns the line by s / sqrt(weight) radians
  bool free = false;                     ///< a chord of a curve, or not straight: gets no direction
  std::uint32_t frame = kNoFrame;        ///< index into RowDirections::frames; its direction where the evidence is strong
  bool across = false;                   ///< a quarter turn from the frame's axis
};

struct RowDirections {
  std::vector<RingWall> walls;           ///< by ring, along it
  std::vector<WallLine> lines;
  std::vector<model::Point2> frames;     ///< unit vectors, x > 0, y >= 0
  std::vector<std::uint32_t> buildings;  ///< those of `rings`, ascending
  std::vector<std::uint32_t> main_frame; ///< parallel to `buildings`; kNoFrame where one has none
  double noise = 0;                      ///< m, standard deviation of one footprint's corner in each coordinate
};

/// Reads the directions of the footprints that have the rings `rings` (indices into graph.rings, ascending): a connected
/// row. Nothing is moved.
///
/// Frame of a building: the direction, modulo a quarter turn, that most of its walls' length agrees with (the mode, then a
/// redescending M-estimate of it; Huber & Ronchetti, Robust Statistics, 2009, ch. 4). A wing at another angle has a frame
/// of its own. Frames of buildings that share a wall are merged, the most alike first, while they differ by no more than
/// the noise of mapping explains: straight rows get one, bent rows keep theirs.
/// Noise: the median sideways deviation of all walls from their frames (Rousseeuw & Leroy, Robust Regression and Outlier
/// Detection, 1987, ch. 5: 1.4826 (1 + 5 / degrees of freedom) median), between kLeastNoise and kLargestNoise.
/// A wall gets a frame's direction when its sideways deviation is within kDeviations times that noise, it is not off by
/// more than kLargestTurn, and, from 8 m of length on, not by 5 degrees less its own uncertainty.
/// The result does not depend on the order of buildings or where rings start, and turns with the row.
RowDirections find_directions(const RowGraph& graph, std::span<const std::uint32_t> rings);

/// How much a corner's position is worth: the number of footprints that have it; a quarter where only a neighbour ends.
double corner_weight(const Corner& corner);
/// What the footprints say about where it is, on average; `start` where none does.
model::Point2 corner_evidence(const Corner& corner);

/// Unit vector of a frame's axis, or of the one across it.
inline model::Point2 axis_of(model::Point2 frame, bool across) {
  return across ? model::Point2{-frame.y, frame.x} : frame;
}

}  // namespace blockrand::repair
