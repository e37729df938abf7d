// Blocks: the land between streets, railways and water.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/context/street_network.h"
#include "pipeline/model/polygon.h"

namespace blockrand::context {

struct BlockOptions {
  /// m, the longer side of the bounding box. Larger blocks give no ratios: the result for a block depends on lines that
  /// come into its box and on nothing else, so a tile that reads this far around a building finds the same block as a
  /// whole build (ARCHITECTURE.md, law 4). Perimeter blocks of Berlin are 100 to 350 m; what is larger is railway land,
  /// parks, fields.
  double max_extent = 1000;
  /// m, 2 area / perimeter: the width of a strip. The green between two carriageways is rarely wider (centre line to
  /// centre line); the narrowest blocks that hold two rows of houses are 30 m and more.
  double max_strip_width = 24;
  /// m, 2 area / perimeter: the radius of a circle. Wider rings of a roundabout hold houses within.
  double max_roundabout_radius = 40;
  /// Of the perimeter: how much of a strip must belong to one street (or to railways) to lie between its carriageways.
  /// The ends of the strip and links at junctions make up the rest.
  double min_same_street = 0.75;
  /// m beyond the coverage: half a building and half a street, since the coverage ends at the centres of the last
  /// buildings and a block in the middle of the street before them.
  double coverage_margin = 30;
  /// m, 2 area / perimeter. No house fits between the centre lines of two streets that are nearer: such faces are
  /// traffic islands and slivers between a street and the outline of its square.
  double min_width = 6;
};

enum class BlockKind : std::uint8_t {
  ordinary,
  between_carriageways,  ///< a strip between the carriageways of one street, or the middle of a roundabout
  between_tracks,        ///< a strip between railway tracks
  street_space,          ///< a pedestrian area, a traffic island, a sliver
  water,
};
inline constexpr std::string_view kBlockKindNames[] = {"ordinary", "between_carriageways", "between_tracks",
                                                       "street_space", "water"};

/// A line that bounds a block.
struct BlockBorder {
  std::uint32_t line = 0;  ///< index of (the first piece of) the line in the input
  double length = 0;       ///< m along the block's rings
};

struct Block {
  /// `w123.n456.l`: the block on the left (r: right) of way 123 where it leaves node 456, with the block on the left of
  /// the way around it. Of all such pairs along the outer ring the one of the least way and, on it, the least node: the
  /// id changes only when that street does. Where no node lies on the ring (four bridges), the least corner on the grid
  /// stands for the node. Of blocks that would have one id, since their street leaves the node more than once, all but
  /// the first in the order of their rings have a number behind it: `w123.n456.l.2`.
  std::string id;
  model::Polygon polygon;  ///< along centre lines, canonical as geometry::Face; holes are islands of other blocks
  double area = 0;         ///< m²
  BlockKind kind = BlockKind::ordinary;
  bool cut_by_extract_edge = false;  ///< reaches beyond the data, or a main street ends in it without a cause
  bool too_large = false;            ///< beyond BlockOptions::max_extent
  std::vector<BlockBorder> borders;  ///< ascending by OSM id
  /// Parallel to the outer ring: whether a street or the outline of a square runs from that point to the next; else it is
  /// a railway, a river, a shore.
  std::vector<bool> along_street;
  /// Ratios are for whole blocks of built land only.
  bool gives_ratios() const { return kind == BlockKind::ordinary && !cut_by_extract_edge && !too_large; }
};

/// Where the data is: the convex hull of points of the extract, as a counter-clockwise ring (empty for fewer than three
/// points not in line). Meant for a point of each building: streets of an extract reach out of it where ways were kept
/// whole, buildings do not. A concave extract has land without data inside its hull; there the streets that end without
/// a cause tell (Block::cut_by_extract_edge).
std::vector<model::Point2> coverage_of(std::span<const model::Point2> points);

/// The bounded faces of the network, in the canonical order of geometry::faces_of_lines. The unbounded face is no
/// block.
///
/// \param coverage  a convex counter-clockwise ring in metres (coverage_of), made once per extract; a block that is not
///                  within `coverage_margin` of its inside is cut. Empty: nothing is known, no block is cut by it.
/// The result does not depend on the order or the direction of lines, but for the `l` and `r` of ids.
std::vector<Block> find_blocks(std::span<const NetworkLine> lines, std::span<const model::Point2> coverage,
                               const BlockOptions& options = {});

}  // namespace blockrand::context
