// Courtyards: open space that buildings surround.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/osm_id.h"
#include "pipeline/model/polygon.h"

namespace blockrand::context {

/// A building on the ground. Footprints do not overlap (after repair); an overlap is built land once.
struct Footprint {
  model::OsmId id;
  model::Polygon polygon;         ///< metres, build CRS; of either orientation
  std::optional<double> storeys;  ///< as tagged, never inferred (ARCHITECTURE.md, law 4)
  bool canopy = false;            ///< building=roof: covers the ground and has no walls
};

using Polyline = std::vector<model::Point2>;

struct CourtyardOptions {
  /// m. A gap this wide between two buildings, or between two wings, is an opening of a courtyard; through a wider one
  /// the space belongs to the street. Gateways and fire lanes are 3 to 6 m, a missing house of a row is 15 m and more.
  double max_opening = 9;
  /// m². Closed courtyards down to light wells count; what is smaller is a gap between walls that almost meet.
  double min_closed_area = 4;
  /// m, 2 area / perimeter. Narrower closed spaces are gaps, too.
  double min_closed_width = 0.5;
  /// m². Smaller spaces behind an opening are passages and recesses of the facade.
  double min_open_area = 40;
  /// m, 2 area / perimeter. Narrower open spaces are alleys between two houses.
  double min_open_width = 3;
  /// Of the perimeter of an open courtyard: how much must be walls.
  double min_enclosure = 0.75;
};

struct Courtyard {
  /// `w123.y456_789`: the least building around it, and the edge of its outer ring that leaves the least corner, as the sum
  /// of both ends in grid steps: no two courtyards have that in common.
  std::string id;
  model::Polygon polygon;  ///< canonical as geometry::Face; holes are buildings that stand free in it
  double area = 0;         ///< m²
  bool closed = true;      ///< no open way to the street space (passages through buildings are not looked at)
  double opening = 0;      ///< m, sum of the gaps that lead out; 0 when closed
  std::vector<std::uint32_t> buildings;  ///< indices of the footprints whose walls surround it, ascending
};

/// The courtyards among the buildings of one block.
///
/// Every gap of at most `max_opening` is closed by its shortest line (from a convex corner to the nearest wall of
/// another building, and of the same building); what walls and lines enclose and no building covers is courtyard.
/// Courtyards that only lines divide are one. Over a street no gap is closed: what a street leads into is street space,
/// also where it ends there. A courtyard depends on the buildings around it alone. The result is in the order of the
/// rings and does not depend on the order of the buildings.
///
/// \param streets  centre lines in metres; those near the block suffice
std::vector<Courtyard> find_courtyards(std::span<const Footprint> buildings, std::span<const Polyline> streets = {},
                                       const CourtyardOptions& options = {});

}  // namespace blockrand::context
