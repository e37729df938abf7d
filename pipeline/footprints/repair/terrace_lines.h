// Walls of a row as lines through its corners.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/footprints/repair/terrace_row.h"

namespace blockrand::repair {

inline constexpr std::uint32_t kNoFrame = 0xffffffff;

/// An edge of a footprint before sharing: the run of a ring's edges that have one `TerraceRing::wall`.
struct RingWall {
  std::uint32_t ring = 0;   ///< index into TerraceGraph::rings
  std::uint32_t first = 0;  ///< its first edge
  std::uint32_t count = 0;  ///< edges
  std::uint32_t line = 0;   ///< index into TerraceLines::lines
};

/// A wall as it stands: all ring walls that share an edge, of however many footprints.
struct WallLine {
  std::vector<std::uint32_t> corners;    ///< along it, each once
  std::vector<std::uint32_t> buildings;  ///< whose wall it is, ascending; indices into TerraceLines::buildings
  model::Point2 along{1, 0};             ///< unit vector of the line fitted through what is said of its corners
  double length = 0;                     ///< m
  double weight = 0;                     ///< m². Noise of s m at a corner turns the line by s / sqrt(weight) radians
  bool free = false;                     ///< a chord of a curve, or not straight: gets no direction
  std::uint32_t frame = kNoFrame;  ///< index into TerraceDirections::frames; its direction where the evidence is strong
  bool across = false;             ///< a quarter turn from the frame's axis
};

struct TerraceLines {
  std::vector<RingWall> walls;  ///< by ring, along it
  std::vector<WallLine> lines;
  std::vector<std::uint32_t> buildings;  ///< those of the rings, ascending: indices into TerraceRow::buildings
};

/// Walls and lines of the rings `rings` (indices into graph.rings, ascending), none with a frame; chords of curves
/// (find_arc_runs) are marked free.
TerraceLines terrace_lines(const TerraceGraph& graph, std::span<const std::uint32_t> rings);

/// Rings of the row in groups that have no corner in common; each ascending.
std::vector<std::vector<std::uint32_t>> connected_rings(const TerraceGraph& graph, std::size_t buildings);

/// How much a corner's position is worth: in how many places footprints have it; a quarter where only a neighbour ends.
double corner_weight(const Corner& corner);
/// What the footprints say about where it is, on average; `start` where none does.
model::Point2 corner_evidence(const Corner& corner);

}  // namespace blockrand::repair
