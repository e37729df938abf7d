// The lines that divide built land into blocks: streets, railways, water. What counts and why is decided here.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/model/osm_id.h"
#include "pipeline/model/point.h"

namespace blockrand::context {

/// What a line is. A `*_link` has the class of its street.
enum class LineClass : std::uint8_t {
  motorway,
  trunk,
  primary,
  secondary,
  tertiary,
  residential,  ///< residential, unclassified, road
  living_street,
  pedestrian,  ///< lines, and outlines of pedestrian areas
  railway,     ///< rail, light_rail, narrow_gauge; not yards and sidings
  waterway,    ///< the middle of a river or canal
  shore,       ///< outline of a water area
  coastline,
  other,  ///< bounds nothing, but shows that a street goes on: service ways, paths, tracks in yards
};

inline bool is_street(LineClass c) { return c <= LineClass::pedestrian; }

struct NetworkLine {
  model::OsmId id;
  LineClass kind = LineClass::other;
  std::string name;
  bool oneway = false;  ///< one carriageway of several, or a one-way street
  bool roundabout = false;
  bool tunnel = false;  ///< under ground; a passage through a building is none
  bool bridge = false;
  bool area = false;  ///< one ring of an area; rings of one area have the same id
  int layer = 0;
  std::vector<model::Point2> points;  ///< m, on the 1/1024 m grid; closed lines and rings repeat the first point
  std::vector<std::int64_t> nodes;    ///< parallel to `points`, or empty
};

/// m². Smaller waters (garden ponds, fountains, basins) lie inside a block and do not divide it.
inline constexpr double kMinWaterArea = 1000;

/// Whether a line bounds blocks.
///
/// * Streets from motorway to residential, living streets and pedestrian streets do; service ways, tracks and paths run
///   inside a block. The outline of a pedestrian area does too: streets end at squares, and without the outline the
///   blocks around a square would be one.
/// * Railways and light railways do where they lie in the open. Trams and elevated undergrounds do not: they run within
///   streets, and their tracks beside a street would cut slivers off every block. Yard and siding tracks do not either.
/// * Rivers, canals, coasts and waters of kMinWaterArea do; streams and ditches run through gardens.
/// * Bridges do: a street on a bridge divides the land below as seen from above. Where it crosses another, blocks end
/// there.
/// * Tunnels do not: houses stand above them. A passage through a building (tunnel=building_passage) does: the street
///   space goes on, and the house stands over it.
bool bounds_blocks(const NetworkLine& line);

using Project = std::function<model::Point2(model::Location)>;

/// The network of an extract, in the order of Extract::features; ways that bound nothing are `other`, without names.
///
/// \param project  WGS 84 to metres in the build CRS; results are rounded to the grid here
std::vector<NetworkLine> network_lines(const model::Extract& extract, const Project& project);

}  // namespace blockrand::context
