// Overlapping areas made into a partition of a square: every place belongs to the strongest area that claims it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/noded_lines.h"
#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

inline constexpr std::uint32_t kNoLabel = ~std::uint32_t{0};

/// An area that claims ground. Rings in metres on the 1/1024 m grid, of either orientation, without their first point
/// repeated; they may cross themselves and each other: what an odd number of them encloses is inside.
struct AreaClaim {
  std::uint32_t label = 0;  ///< areas of one label make one piece where they touch
  std::vector<std::vector<model::Point2>> rings;
  PlanBox box;  ///< of the rings
  /// `rings` are lines, open or closed, with land on their left as coasts have it: what lies on the right of the nearest of them is
  /// inside, as far as it is within kCoastReach of one.
  bool right_of_lines = false;
};

/// m. Beyond, nobody knows on which side of a coast a place lies.
inline constexpr double kCoastReach = 2000;

/// Whether a place is inside of what an area claims. Borders may count either way.
bool claim_holds(const AreaClaim& claim, model::Point2 place);

struct PartitionPiece {
  std::uint32_t label = kNoLabel;  ///< kNoLabel: nobody claims it
  /// As geometry::Face has it: outer ring counter-clockwise, holes clockwise, each beginning at its least point. Points where
  /// neither the border turns nor the neighbour changes are left out, on both sides alike.
  model::Polygon polygon;
  /// What lies beyond each edge: parallel to the vertices, outer ring first, then the holes, of the edge that starts there.
  /// Beyond the square, too.
  std::vector<std::uint32_t> beyond;
};

/// m². Smaller faces of the arrangement, which lines that nearly coincide leave, go to their longest neighbour, but for those at the border.
inline constexpr double kSliverArea = 0.002;

/// The pieces of a square, in the order of their outer rings. Pieces cover it and do not overlap: borders are shared point for
/// point (noded_edges). A line that crosses the border of a square meets it where it does so for the square beyond: each side
/// works out the same point from the line alone.
///
/// \param square  its corners on the grid
/// \param claims  the strongest first; those that do not come near do no harm
/// \param lines   cut pieces where they run through: lines of a terrain. None may leave the square
/// Cost: O(n log n) in segments within the square, plus faces times claims that have an edge in it.
std::vector<PartitionPiece> partition_of(const PlanBox& square, std::span<const AreaClaim> claims,
                                         std::span<const DividingLine> lines = {});

}  // namespace blockrand::geometry
